// The GGX reflection as shader code: the view, the table of lobes, masking, one direction of light.
#pragma once

#include <string>
#include <vector>

#include "lobelia/shader_code.h"

namespace lobelia::ggx_shader {

/// What code uses. `layers`: the layers of the table at (n.v, alpha), of which layer 0 is always there.
/// `normal_layers`: those at (1, alpha). `across`: view.y, the direction across the plane of incidence.
struct Uses {
    std::size_t layers = 1, normal_layers = 0;
    enum class Across { no, yes } across = Across::no;
};
/// Returns ggx_coordinates(cosine, alpha), struct GgxTexels with members view_<layer> and normal_<layer>, struct
/// GgxView {x, y, z, sine, cosine, alpha}, ggx_view(n, v, alpha).
[[nodiscard]] std::vector<ShaderFunction> view_functions(const Uses& uses);

/// vec3 ggx_mirror(view) and vec3 ggx_axis(view, tilt): the mirror direction, and the mean direction of reflected light
/// from the table's sine.
[[nodiscard]] const ShaderFunction& mirror();
[[nodiscard]] const ShaderFunction& axis();
/// vec3 ggx_local(view, w): components in the frame of the view; needs view.y.
[[nodiscard]] const ShaderFunction& local();
/// float ggx_masking(alpha2, cosine2): 1 + 2 Lambda.
[[nodiscard]] const ShaderFunction& masking();
/// float ggx_reflection(view, alpha2, masking, p): D G / (4 n.v) for light from p in the view's frame; `masking` is
/// that of the viewer. Calls masking().
[[nodiscard]] const ShaderFunction& reflection();

}  // namespace lobelia::ggx_shader
