// The study of irradiance from one spherical Gaussian: every evaluator against the exact series.
#pragma once

#include "measure/study/study.h"

namespace lobelia {

/// Errors over sharpness, the clamped cosine beside its approximations, irradiance against angle, lit spheres.
[[nodiscard]] Study study_sg_irradiance();

}  // namespace lobelia
