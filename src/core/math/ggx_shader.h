// The GGX reflection as shader code: the view, the table of lobes, masking, one direction of light.
#pragma once

#include <string>
#include <vector>

#include "lobelia/shader_code.h"

namespace lobelia::ggx_shader {

/// What code uses of a view: its plane of incidence, x and z; also y across it; also the direction to the viewer.
enum class Frame { plane, across, viewer };
/// `layers`: the layers of the table at (n.v, alpha), at least 1. `normal_layers`: those at (1, alpha).
struct Uses {
    std::size_t layers = 1, normal_layers = 0;
    Frame frame = Frame::plane;
};
/// Returns ggx_coordinates(cosine, alpha), struct GgxTexels with members view_<layer> and normal_<layer>, struct
/// GgxView {x, y, z, viewer, sine, cosine, alpha} and ggx_view(n, v, alpha).
[[nodiscard]] std::vector<ShaderFunction> view_functions(const Uses& uses);

/// vec3 ggx_mirror(view) and vec3 ggx_axis(view, tilt): the mirror direction, and the mean direction of reflected light
/// from the table's sine.
[[nodiscard]] const ShaderFunction& mirror();
[[nodiscard]] const ShaderFunction& axis();
/// vec3 ggx_sum(view, w): the sum of the directions to the viewer and w, in the frame of the view. Needs Frame::viewer.
[[nodiscard]] const ShaderFunction& sum();
/// float ggx_masking(alpha2, cosine2): 1 + 2 Lambda.
[[nodiscard]] const ShaderFunction& masking();
/// float ggx_reflection(view, alpha2, masking, w): D G / (4 n.v) for light from w; `masking` is that of the viewer.
/// Calls masking() and sum().
[[nodiscard]] const ShaderFunction& reflection();

}  // namespace lobelia::ggx_shader
