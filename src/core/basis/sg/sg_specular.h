// Glossy reflection of spherical Gaussians: published approximations, and a new one that is exact at both ends.
// Wang et al. 2009; Xu et al. 2013; Pettineo 2016 (part 4); Tokuyoshi et al. 2024.
#pragma once

#include <optional>
#include <string_view>

#include "core/math/gaussian.h"
#include "core/math/ggx.h"
#include "lobelia/specular.h"

namespace lobelia {

/// punctual: all light comes from the axis. sg_warp, asg_warp: the reflection as one Gaussian, or one with two widths.
/// tokuyoshi_2024: GGX widened by the light's width, times the share of the light above the horizon. moments: the
/// reflection as the Gaussian of its albedo and mean direction. masked: tokuyoshi_2024 with the masking of the real
/// surface, exact for punctual light. two_ends: from moments, where light is broad, to masked, where it is narrow.
enum class SgSpecular { punctual, sg_warp, asg_warp, tokuyoshi_2024, moments, masked, two_ends };

struct SgSpecularInfo {
    SgSpecular kind;
    std::string_view name;
    /// Largest relative error, root mean square over all axes of a lobe over root mean square of the reference, for
    /// alpha 0.1 to 0.8, n.v 0.25 to 1, sharpness 2 to 64; tested.
    double error;
};
[[nodiscard]] std::span<const SgSpecularInfo> sg_specular_list();
[[nodiscard]] std::optional<SgSpecular> sg_specular_from_name(std::string_view name);

/// Evaluates the reflected light of a unit lobe at each axis, in the view's own frame. For sharpness 0, ambient light,
/// every kind gives the surface's albedo.
[[nodiscard]] std::vector<float> sg_specular(SgSpecular kind, const ggx::View& view, float sharpness,
                                             DirectionView axes);

/// Names of the kinds, the most accurate last, and one of them for fixed lobes; null if the name is none of these.
[[nodiscard]] std::vector<std::string> sg_specular_names();
[[nodiscard]] std::shared_ptr<const SpecularEvaluator> make_sg_specular(std::string_view name,
                                                                        std::vector<gaussian::Lobe> lobes);

}  // namespace lobelia
