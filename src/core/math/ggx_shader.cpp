// Shader code of the GGX reflection; ggx.cpp and ggx_lobe_table.cpp have the same in C++.
#include "core/math/ggx_shader.h"

#include <cmath>

#include "core/math/ggx.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"

namespace lobelia::ggx_shader {
namespace {

using shader_text::filled;
using shader_text::literal;

ShaderFunction coordinates() {
    const auto side = static_cast<double>(ggx::k_table_side);
    return {
        "ggx_coordinates",
        filled(
            R"(/// Returns where to sample the table, ggx-lobe.ktx2: in the middle of a texel at either end. `cosine` is n.v.
vec2 ggx_coordinates(float cosine, float alpha) {
    float c = clamp(cosine, $0, 1.0);
    return vec2(sqrt(c / (1.0 + sqrt(1.0 - c))), sqrt(clamp(alpha, $1, 1.0))) * $2 + $3;
}
)",
            {literal(ggx::k_least_cosine), literal(ggx::k_least_alpha), literal((side - 1) / side),
             literal(0.5 / side)})};
}

ShaderFunction texels(const Uses& uses) {
    std::string text = "/// Layers of the table, filtered: view_* sampled at ggx_coordinates(dot(n, v), alpha)" +
                       std::string(uses.normal_layers > 0 ? ",\n/// normal_* at ggx_coordinates(1.0, alpha)" : "") +
                       ".\nstruct GgxTexels {\n";
    for (std::size_t i = 0; i < uses.layers; ++i) text += "    vec4 view_" + std::to_string(i) + ";\n";
    for (std::size_t i = 0; i < uses.normal_layers; ++i) text += "    vec4 normal_" + std::to_string(i) + ";\n";
    return {"GgxTexels", text + "};\n"};
}

ShaderFunction view_struct(Frame frame) {
    return {
        "GgxView",
        filled(
            R"(/// A surface as its viewer sees it. z is the normal, x the viewer's side of the tangent plane; sine and cosine are those
/// of the angle between normal and viewer.
struct GgxView {
    vec3 x;
$0    vec3 z;
$1    float sine;
    float cosine;
    float alpha;
};
)",
            {frame == Frame::plane ? "" : "    vec3 y;\n", frame == Frame::viewer ? "    vec3 viewer;\n" : ""})};
}

ShaderFunction view_function(Frame frame) {
    const std::string viewer = filled(R"(    view.viewer = v;
    if (cosine <= $0) {
        view.viewer = view.x * view.sine + n * view.cosine;
    }
)",
                                      {literal(ggx::k_least_cosine)});
    const double most_sine = std::sqrt(1 - static_cast<double>(ggx::k_least_cosine) * ggx::k_least_cosine);
    return {"ggx_view",
            filled(R"(/// Returns the view from the unit direction v. Views below the surface count as grazing ones.
GgxView ggx_view(vec3 n, vec3 v, float alpha) {
    float cosine = dot(n, v);
    vec3 along = v - n * cosine;
    GgxView view;
    view.sine = choose(cosine > $0, min(length(along), 1.0), $1);
    view.cosine = clamp(cosine, $0, 1.0);
    view.alpha = clamp(alpha, $2, 1.0);
    // A view along the normal has no side of its own: take any.
    if (dot(along, along) < 1.0e-12) {
        float upright = choose(abs(n.z) < 0.9, 1.0, 0.0);
        along = cross(n, vec3(1.0 - upright, 0.0, upright));
    }
    view.x = normalize(along);
$3    view.z = n;
$4    return view;
}
)",
                   {literal(ggx::k_least_cosine), literal(most_sine), literal(ggx::k_least_alpha),
                    frame == Frame::plane ? "" : "    view.y = cross(n, view.x);\n",
                    frame == Frame::viewer ? viewer : ""})};
}

}  // namespace

std::vector<ShaderFunction> view_functions(const Uses& uses) {
    return {coordinates(), texels(uses), view_struct(uses.frame), view_function(uses.frame)};
}

const ShaderFunction& mirror() {
    static const ShaderFunction k_mirror = {"ggx_mirror", R"(/// Returns the mirror direction of the viewer.
vec3 ggx_mirror(GgxView view) {
    return view.z * view.cosine - view.x * view.sine;
}
)"};
    return k_mirror;
}

const ShaderFunction& axis() {
    static const ShaderFunction k_axis = {
        "ggx_axis",
        R"(/// Returns the mean direction of reflected light: the mirror direction, turned by the angle of which `tilt` is the sine.
vec3 ggx_axis(GgxView view, float tilt) {
    float upright = sqrt(1.0 - tilt * tilt);
    return view.z * (view.cosine * upright - view.sine * tilt) - view.x * (view.sine * upright + view.cosine * tilt);
}
)"};
    return k_axis;
}

const ShaderFunction& sum() {
    static const ShaderFunction k_sum = {
        "ggx_sum",
        R"(/// Returns the sum of the unit directions to the viewer and w, in the frame of the view. Summed up before it is turned,
/// it has its digits where the two are nearly opposite.
vec3 ggx_sum(GgxView view, vec3 w) {
    vec3 h = view.viewer + w;
    return vec3(dot(view.x, h), dot(view.y, h), dot(view.z, h));
}
)"};
    return k_sum;
}

const ShaderFunction& masking() {
    static const ShaderFunction k_masking = {
        "ggx_masking", R"(/// Returns 1 + 2 Lambda, Smith's Lambda of a direction with this squared cosine.
float ggx_masking(float alpha2, float cosine2) {
    return sqrt(1.0 + alpha2 * (1.0 - cosine2) / cosine2);
}
)"};
    return k_masking;
}

const ShaderFunction& reflection() {
    static const ShaderFunction k_reflection = {
        "ggx_reflection", filled(
                              R"(/// Returns D G / (4 n.v) [1/sr] for light from w; `masking` is that of the viewer.
float ggx_reflection(GgxView view, float alpha2, float masking, vec3 w) {
    vec3 h = ggx_sum(view, w);
    float z = h.z - view.cosine;
    float stretched = dot(h, h) / (h.x * h.x + h.y * h.y + alpha2 * h.z * h.z);
    float both = masking + ggx_masking(alpha2, clamp(z * z, 1.0e-12, 1.0));
    return choose(z > 0.0, alpha2 * stretched * stretched / ($0 * view.cosine * both), 0.0);
}
)",
                              {literal(2 * k_pi)})};
    return k_reflection;
}

}  // namespace lobelia::ggx_shader
