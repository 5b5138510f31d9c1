// The two published comparisons on ennis.hdr, reproduced exactly, with their noisy reference and their quirks.
// Roughton 2018: the first version of the post (published) and its corrected one (updated).
#pragma once

#include "measure/comparison.h"

namespace lobelia {

/// published: 20,000 Hammersley samples, shuffled for the running averages. updated: Halton samples, not shuffled, and
/// the progressive form with sampled denominators. Both: 12 spherical Gaussians, Hill's fit, a reference irradiance of
/// 5,000 draws, root mean squares over latitude-longitude texels without solid angle.
enum class Recipe { published, updated };

[[nodiscard]] std::string_view recipe_name(Recipe recipe);

/// Method::irradiance_over_pi and radiance hold the published figures in rms_unweighted (summed in float32, in order).
/// `pictures` as in ComparisonOptions.
[[nodiscard]] Comparison run_recipe(Recipe recipe, const Image& environment, const ComparisonOptions& options = {},
                                    const Progress& progress = {});

}  // namespace lobelia
