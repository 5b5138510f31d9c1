// The study of glossy reflection from spherical Gaussians and spherical harmonics.
#pragma once

#include "lobelia/study.h"

namespace lobelia {

/// Error tables of every reading over roughness, view angle and sharpness, curves, and lit spheres.
[[nodiscard]] Study study_specular();

}  // namespace lobelia
