// Shader code of glossy reflection of spherical Gaussians; sg_specular_lanes.cpp has the same for lanes. What depends
// on the view and the sharpness alone is computed once and kept in a struct; lobes of one sharpness share it. Wang et
// al. 2009; Xu et al. 2013; Pettineo 2016 (part 4); Tokuyoshi 2022; Tokuyoshi et al. 2024.
#include "core/basis/sg/sg_specular_shader.h"

#include <algorithm>
#include <array>

#include "core/math/ggx_shader.h"
#include "core/math/shader_pattern.h"
#include "core/math/shader_text.h"

namespace lobelia::sg_shader {
namespace {

using shader_text::coefficient;
using shader_text::filled;
using shader_text::literal;
using Functions = std::vector<ShaderFunction>;

const ShaderFunction k_integral = {"lobe_integral", R"(/// Returns the integral of a lobe over the sphere.
float lobe_integral(float sharpness) {
    float x = 2.0 * sharpness;
    float series = 1.0 - x * (0.5 - x * (0.16666667 - x * (0.041666667 - x * (0.0083333333 - x * 0.0013888889))));
    return 12.566371 * choose(x < 0.3, series, (1.0 - exp(-x)) / x);
}
)"};

const ShaderFunction k_mean = {
    "lobe_mean",
    R"(/// Returns the mean cosine of a lobe to its axis, coth(s) - 1 / s: a continued fraction for broad ones.
float lobe_mean(float s) {
    float y = s * s;
    float fraction = s / (3.0 + y / (5.0 + y / (7.0 + y / (9.0 + y / 11.0))));
    return choose(s < 1.5, fraction, 1.0 + 2.0 / (exp(min(2.0 * s, 80.0)) - 1.0) - 1.0 / s);
}
)"};

const ShaderFunction k_error = {"error_function", R"(/// Returns erf(x), x >= 0, off by at most 1.5e-7 (Hastings 1955).
float error_function(float x) {
    float t = 1.0 / (1.0 + 0.3275911 * x);
    float fit = (((1.0614054 * t - 1.4531521) * t + 1.4214138) * t - 0.28449672) * t + 0.2548296;
    return 1.0 - fit * t * exp(-x * x);
}
)"};

const ShaderFunction k_share = {
    "share_above",
    R"(/// Returns the share of a lobe above the horizon; `cosine` is that of its axis to the normal (Tokuyoshi 2022).
float share_above(float cosine, float sharpness) {
    float s = max(sharpness, 0.01);
    float t = s * sqrt((0.5 * s + 0.6517329) / ((s + 1.341828) * s + 7.221669));
    float ratio = min(error_function(t * abs(cosine)) / error_function(t), 1.0);
    float above = 0.5 + 0.5 * choose(cosine < 0.0, -ratio, ratio);
    float below = exp(-s);
    return (above * (1.0 - below) + below) / (1.0 + below);
}
)"};

const ShaderFunction k_inverse_width = {
    "inverse_width",
    R"(/// Returns one over the squared width alpha2 of GGX, widened by a light of squared width 1 / steepness in normals
/// (Tokuyoshi and Kaplanyan 2021).
float inverse_width(float alpha2, float steepness) {
    float rest = 1.0 - alpha2;
    return (steepness + rest) / (alpha2 * steepness + rest);
}
)"};

/// The reflection of a kind: a struct of what depends on the view and the sharpness, and a lobe's reflected light from
/// it.
struct Reflection {
    std::string_view make;  ///< $0 sharpness, $1 integral, $2 mean cosine, $3 one minus it
    std::string_view type;
    std::string_view lobe;  ///< $0 the struct, $1 the axis
    ggx_shader::Uses uses;
    Functions functions;  ///< without those of the view
};

Reflection punctual() {
    return {"sg_punctual(view, $1)",
            "SgPunctual",
            "punctual_lobe(view, $0, $1)",
            {1, 0, ggx_shader::Frame::viewer},
            {ggx_shader::sum(),
             ggx_shader::masking(),
             ggx_shader::reflection(),
             {"SgPunctual", R"(/// The surface, and the integral of a lobe.
struct SgPunctual {
    float alpha2;
    float masking;
    float integral;
};
)"},
             {"sg_punctual", R"(SgPunctual sg_punctual(GgxView view, float integral) {
    SgPunctual s;
    s.alpha2 = view.alpha * view.alpha;
    s.masking = ggx_masking(s.alpha2, view.cosine * view.cosine);
    s.integral = integral;
    return s;
}
)"},
             {"punctual_lobe", R"(/// Returns the reflected light of a lobe, all of it from its axis.
float punctual_lobe(GgxView view, SgPunctual s, vec3 axis) {
    return s.integral * ggx_reflection(view, s.alpha2, s.masking, axis);
}
)"}}};
}

Reflection sg_warp() {
    return {
        "sg_warp(view, $0)",
        "SgWarp",
        "warp_lobe($0, $1)",
        {},
        {ggx_shader::mirror(),
         ggx_shader::masking(),
         k_integral,
         {"SgWarp",
          R"(/// The reflection as a Gaussian about the mirror direction, with a lobe (Wang et al. 2009): difference, sum and product
/// of their sharpness.
struct SgWarp {
    vec3 mirror;
    float difference;
    float sum;
    float product;
    float peak;
};
)"},
         {"sg_warp", R"(SgWarp sg_warp(GgxView view, float sharpness) {
    float alpha2 = view.alpha * view.alpha;
    float warped = 0.5 / (alpha2 * view.cosine);
    SgWarp s;
    s.mirror = ggx_mirror(view);
    s.difference = warped - sharpness;
    s.sum = warped + sharpness;
    s.product = warped * sharpness;
    s.peak = 0.079577472 / (alpha2 * view.cosine * ggx_masking(alpha2, view.cosine * view.cosine));
    return s;
}
)"},
         {"warp_lobe", R"(/// Returns the reflected light of a lobe, the integral of a product of two.
float warp_lobe(SgWarp s, vec3 axis) {
    vec3 apart = s.mirror - axis;
    vec3 together = s.mirror + axis;
    float u = sqrt(s.difference * s.difference + s.product * dot(together, together));
    return s.peak * exp(-s.product * dot(apart, apart) / (u + s.sum)) * lobe_integral(u);
}
)"}}};
}

Reflection asg_warp() {
    return {
        "asg_warp(view, $0)",
        "AsgWarp",
        "warp_lobe(view, $0, $1)",
        {1, 0, ggx_shader::Frame::across},
        {ggx_shader::mirror(),
         ggx_shader::masking(),
         {"AsgWarp",
          R"(/// The reflection as a Gaussian of two widths about the mirror direction, convolved with a lobe (Xu et al. 2013).
struct AsgWarp {
    vec3 mirror;
    vec3 along;
    float fall_along;
    float fall_across;
    float peak;
};
)"},
         {"asg_warp", R"(AsgWarp asg_warp(GgxView view, float sharpness) {
    float alpha2 = view.alpha * view.alpha;
    float light = 0.5 * sharpness;
    float along = 0.25 / alpha2;
    float across = along / (view.cosine * view.cosine);
    AsgWarp s;
    s.mirror = ggx_mirror(view);
    s.along = view.x * view.cosine + view.z * view.sine;
    s.fall_along = light * along / (light + along);
    s.fall_across = light * across / (light + across);
    float width = sqrt(light + along) * sqrt(light + across);
    s.peak = 0.25 / (alpha2 * view.cosine * ggx_masking(alpha2, view.cosine * view.cosine) * width);
    return s;
}
)"},
         {"warp_lobe", R"(/// Returns the reflected light of a lobe.
float warp_lobe(GgxView view, AsgWarp s, vec3 axis) {
    float along = dot(s.along, axis);
    float across = dot(view.y, axis);
    float facing = max(dot(s.mirror, axis), 0.0);
    return s.peak * facing * exp(-s.fall_along * along * along - s.fall_across * across * across);
}
)"}}};
}

Reflection tokuyoshi_2024() {
    return {
        "sg_widened(view, $0, $1)",
        "SgWidened",
        "widened_lobe(view, $0, $1)",
        {1, 0, ggx_shader::Frame::viewer},
        {ggx_shader::sum(),
         k_error,
         k_share,
         k_inverse_width,
         {"SgWidened",
          R"(/// GGX widened by a lobe (Tokuyoshi et al. 2024): one over its squared widths, along and across the plane of incidence.
/// `mirror` is the axis times the sharpness of the reflection as a broad Gaussian, in the frame of the view.
struct SgWidened {
    vec3 mirror;
    float sharpness;
    float along;
    float across;
    float peak;
};
)"},
         {"sg_widened", filled(R"(SgWidened sg_widened(GgxView view, float sharpness, float integral) {
    float alpha2 = view.alpha * view.alpha;
    float cosine2 = view.cosine * view.cosine;
    SgWidened s;
    s.mirror = (0.5 / alpha2 - 0.5) * vec3(-view.sine, 0.0, view.cosine);
    s.sharpness = sharpness;
    s.along = inverse_width(alpha2, 2.0 * sharpness);
    s.across = inverse_width(alpha2, 2.0 * sharpness * cosine2);
    // Smith's visible area of the widened surface, over sqrt(along).
    float projection = sqrt(view.sine * view.sine + s.along * cosine2);
    s.peak = $0 * integral * s.along * sqrt(s.across) / projection;
    return s;
}
)",
                               {literal(1 / (4 * k_pi))})},
         {"widened_lobe",
          R"(/// Returns the reflected light of a lobe: the widened distribution at the half vector, times the share of the light above
/// the horizon.
float widened_lobe(GgxView view, SgWidened s, vec3 axis) {
    vec3 h = ggx_sum(view, axis);
    // The axis times the sharpness of the light times the reflection.
    vec3 both = s.sharpness * (h - vec3(view.sine, 0.0, view.cosine)) + s.mirror;
    float sharpness = length(both);
    float share = share_above(both.z / max(sharpness, 1.0e-20), sharpness);
    // The distribution at the half vector, the normal where viewer and light are opposite.
    float stretched = h.x * h.x * s.along + h.y * h.y * s.across + h.z * h.z;
    float ratio = (dot(h, h) + 1.0e-12) / (stretched + 1.0e-12);
    return s.peak * share * ratio * ratio;
}
)"}}};
}

Reflection moments() {
    return {"sg_moments(view, texels, $1, $2, $3)",
            "SgMoments",
            "moments_lobe($0, $1)",
            {},
            {ggx_shader::axis(),
             k_integral,
             {"gaussian_sharpness",
              R"(/// Returns the sharpness of the lobe of mean cosine 1 - spread (Banerjee et al. 2005; within 4 %).
float gaussian_sharpness(float spread) {
    float d = max(spread, 1.0e-12);
    float r = 1.0 - d;
    return r * (3.0 - r * r) / (d * (2.0 - d));
}
)"},
             {"SgMoments",
              R"(/// The Gaussian with the albedo and the mean direction of the reflection, convolved with a lobe.
struct SgMoments {
    vec3 axis;
    float sharpness;
    float peak;
};
)"},
             {"sg_moments", R"(/// `mean` is the mean cosine of the lobe, `spread` 1 - mean.
SgMoments sg_moments(GgxView view, GgxTexels texels, float integral, float mean, float spread) {
    float root = texels.view_0.w * view.alpha;
    SgMoments s;
    s.axis = ggx_axis(view, texels.view_0.z);
    s.sharpness = gaussian_sharpness(mean * root * root + spread);
    s.peak = texels.view_0.x * integral / lobe_integral(s.sharpness);
    return s;
}
)"},
             {"moments_lobe", R"(/// Returns the reflected light of a lobe.
float moments_lobe(SgMoments s, vec3 axis) {
    vec3 apart = s.axis - axis;
    return s.peak * exp(-0.5 * s.sharpness * dot(apart, apart));
}
)"}}};
}

Reflection masked() {
    return {
        "sg_masked(view, $0, $1)",
        "SgMasked",
        "masked_lobe(view, $0, $1)",
        {1, 0, ggx_shader::Frame::viewer},
        {ggx_shader::sum(),
         ggx_shader::masking(),
         k_error,
         k_share,
         k_inverse_width,
         {"SgMasked",
          R"(/// GGX widened by a lobe, masked as the real surface is: one over its squared width along the plane of incidence.
/// `mirror` is the axis times the sharpness of the reflection as a broad Gaussian, in the frame of the view.
struct SgMasked {
    vec3 mirror;
    float sharpness;
    float alpha2;
    float along;
    float masking;
    float peak;
};
)"},
         {"sg_masked", filled(R"(SgMasked sg_masked(GgxView view, float sharpness, float integral) {
    SgMasked s;
    s.alpha2 = view.alpha * view.alpha;
    s.mirror = (0.5 / s.alpha2 - 0.5) * vec3(-view.sine, 0.0, view.cosine);
    s.sharpness = sharpness;
    s.along = inverse_width(s.alpha2, 2.0 * sharpness);
    s.masking = ggx_masking(s.alpha2, view.cosine * view.cosine);
    // Smith's visible area of the widened surface, over sqrt(along).
    float projection = sqrt(view.sine * view.sine + s.along * view.cosine * view.cosine);
    s.peak = $0 * integral * s.masking * s.along / projection;
    return s;
}
)",
                              {literal(1 / (2 * k_pi))})},
         {"masked_lobe", filled(R"(/// Returns the reflected light of a lobe.
float masked_lobe(GgxView view, SgMasked s, vec3 axis) {
    vec3 h = ggx_sum(view, axis);
    // The axis times the sharpness of the light times the reflection.
    vec3 both = s.sharpness * (h - vec3(view.sine, 0.0, view.cosine)) + s.mirror;
    float sharpness = length(both);
    float cosine = both.z / max(sharpness, 1.0e-20);
    // Mask light at the product's axis, lifted softly above the horizon.
    float lifted = 0.5 * (cosine + sqrt(cosine * cosine + $0 / (sharpness + 1.0)));
    float masking = s.masking + ggx_masking(s.alpha2, clamp(lifted * lifted, 1.0e-12, 1.0));
    // The widened distribution at the half vector, whose cosine to the viewer is half its length before it is unit.
    float squared = dot(h, h) + 1.0e-12;
    float jacobian = max(mix(view.cosine, 0.5 * sqrt(squared), $1), 0.05);
    float across = inverse_width(s.alpha2, 2.0 * s.sharpness * jacobian * jacobian);
    float ratio = squared / (h.x * h.x * s.along + h.y * h.y * across + h.z * h.z + 1.0e-12);
    return s.peak * share_above(cosine, sharpness) * ratio * ratio * sqrt(across) / masking;
}
)",
                                {literal(k_gloss_soft), literal(k_gloss_half)})}}};
}

Reflection two_ends() {
    Reflection broad = moments(), narrow = masked();
    Reflection both{"sg_two_ends(view, texels, $0, $1, $2, $3)", "SgTwoEnds", "two_ends_lobe(view, $0, $1)",
                    narrow.uses, broad.functions};
    both.functions.insert(both.functions.end(), narrow.functions.begin(), narrow.functions.end());
    both.functions.push_back(
        {"SgTwoEnds", R"(/// The two, the first where light is broad, the second where it is narrow.
struct SgTwoEnds {
    SgMoments broad;
    SgMasked narrow;
};
)"});
    both.functions.push_back(
        {"sg_two_ends",
         filled(
             R"(SgTwoEnds sg_two_ends(GgxView view, GgxTexels texels, float sharpness, float integral, float mean, float spread) {
    float root = texels.view_0.w * view.alpha;
    float middle = $0 * gaussian_sharpness(root * root) * pow(view.cosine, $1);
    float t = pow(min(sharpness / middle, 1.0e5), $2);
    SgTwoEnds s;
    s.broad = sg_moments(view, texels, integral, mean, spread);
    s.narrow = sg_masked(view, sharpness, integral);
    s.broad.peak *= 1.0 / (1.0 + t);
    s.narrow.peak *= t / (1.0 + t);
    return s;
}
)",
             {literal(k_gloss_middle), literal(k_gloss_grazing), literal(k_gloss_steepness)})});
    both.functions.push_back({"two_ends_lobe", R"(/// Returns the reflected light of a lobe.
float two_ends_lobe(GgxView view, SgTwoEnds s, vec3 axis) {
    return moments_lobe(s.broad, axis) + masked_lobe(view, s.narrow, axis);
}
)"});
    return both;
}

Reflection reflection_of(SgSpecular kind) {
    // In the order of the kinds.
    constexpr std::array k_reflections = {punctual, sg_warp, asg_warp, tokuyoshi_2024, moments, masked, two_ends};
    return k_reflections[static_cast<std::size_t>(kind)]();
}

/// The functions of the view and then those of the reflection.
Functions all_functions(const Reflection& reflection) {
    Functions list = ggx_shader::view_functions(reflection.uses);
    list.insert(list.end(), reflection.functions.begin(), reflection.functions.end());
    return list;
}

constexpr std::string_view k_view = "    GgxView view = ggx_view(n, v, alpha);\n";

}  // namespace

ShaderCode reflected(SgSpecular kind, std::span<const SgLight> lights) {
    const Reflection reflection = reflection_of(kind);

    // One struct for each sharpness.
    std::vector<float> sharpness;
    std::string surfaces;
    for (const SgLight& light : lights)
        if (light.sharpness >= k_ambient_sharpness &&
            std::find(sharpness.begin(), sharpness.end(), light.sharpness) == sharpness.end())
            sharpness.push_back(light.sharpness);
    const auto name_of = [&](float s) {
        const auto place = std::find(sharpness.begin(), sharpness.end(), s) - sharpness.begin();
        return sharpness.size() == 1 ? "surface" : "surface_" + std::to_string(place);
    };
    for (const float s : sharpness) {
        const SgLight& light =
            *std::find_if(lights.begin(), lights.end(), [&](const SgLight& l) { return l.sharpness == s; });
        surfaces +=
            filled("    $0 $1 = ", {std::string(reflection.type), name_of(s)}) +
            filled(reflection.make, {literal(s), literal(light.integral), literal(light.mean), literal(light.spread)}) +
            ";\n";
    }

    std::vector<std::string> weights;
    for (const SgLight& light : lights)
        weights.push_back(light.sharpness < k_ambient_sharpness
                              ? "texels.view_0.x"
                              : filled(reflection.lobe, {name_of(light.sharpness), literal(light.axis)}));
    ShaderCode code = shader_text::sum_of(weights, "sum");
    code.functions = all_functions(reflection);
    code.statements = std::string(k_view) + surfaces + code.statements;
    return code;
}

ShaderCode fitted_reflected(SgSpecular kind, std::size_t count) {
    const Reflection reflection = reflection_of(kind);
    ShaderCode code{all_functions(reflection), std::string(k_view), "sum"};
    const bool with_integral = reflection.make.find("$1") != std::string_view::npos;
    const bool with_mean = reflection.make.find("$2") != std::string_view::npos;
    if (with_integral) code.functions.push_back(k_integral);
    if (with_mean) code.functions.push_back(k_mean);
    std::string mean = with_mean ? "    float mean = lobe_mean(sharpness);\n"
                                   "    // 1 - mean, without its cancellation.\n"
                                   "    float spread = choose(sharpness < 1.5, 1.0 - mean, 1.0 / sharpness - 2.0 / "
                                   "(exp(min(2.0 * sharpness, 80.0)) - 1.0));\n"
                                 : "";
    code.functions.push_back({"fitted_lobe",
                              "/// Returns the reflected light of a lobe; `axis` is its axis times its sharpness, of "
                              "which 10000 is the most.\n"
                              "float fitted_lobe(GgxView view, GgxTexels texels, vec3 axis) {\n"
                              "    float size = length(axis);\n"
                              "    float sharpness = clamp(size, 1.0e-6, 10000.0);\n" +
                                  mean + filled("    $0 s = ", {std::string(reflection.type)}) +
                                  filled(reflection.make, {"sharpness", "lobe_integral(sharpness)", "mean", "spread"}) +
                                  ";\n" +
                                  "    // Without a sharpness it is ambient light.\n"
                                  "    return choose(size < 1.0e-8, texels.view_0.x, " +
                                  filled(reflection.lobe, {"s", "axis / max(size, 1.0e-8)"}) + ");\n}\n"});
    for (std::size_t i = 0; i < count; ++i)
        code.statements += filled("    $0$1 * fitted_lobe(view, texels, $2);\n",
                                  {i == 0 ? "vec3 sum = " : "sum += ", coefficient(2 * i), coefficient(2 * i + 1)});
    return code;
}

}  // namespace lobelia::sg_shader
