// The candidates among which advise() chooses, measured on an environment or at the texels of a scene.
#pragma once

#include "lobelia/image.h"
#include "lobelia/scene.h"
#include "measure/advice.h"
#include "measure/progress.h"

namespace lobelia {

/// Measures every listed codec of the domain in every storage whose error depends on a texel's own coefficients alone;
/// of the encoders, the best one of each basis and evaluator. Error: specular is needed of the hemisphere.
[[nodiscard]] Result<Advice> advise(const Image& environment, Domain domain, const AdviceOptions& options = {},
                                    const Progress& progress = {});

/// Measures every codec in every storage at `texels` lightmap texels of the scene, spread evenly. Error: anything but
/// irradiance is needed.
[[nodiscard]] Result<Advice> advise(const Scene& scene, std::size_t texels, const AdviceOptions& options = {},
                                    const Progress& progress = {});

}  // namespace lobelia
