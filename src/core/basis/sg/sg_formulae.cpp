// The formulae of irradiance of a spherical Gaussian, as shader code; sg_irradiance.cpp has the same for lanes.
// Wang et al. 2009; Pettineo 2016 (parts 3 and 4; the fit by S. Hill); Meder and Bruederlin 2018; Tokuyoshi 2024.
// Abramowitz and Stegun 1964 (9.8.3, 9.8.4: the Bessel function I_1).
#include "core/basis/sg/sg_formulae.h"

#include <array>

#include "core/math/shader_pattern.h"

namespace lobelia::sg_shader {
namespace {

const ShaderFunction k_erfc = {"complementary_error", R"(/// Returns erfc(x), off by at most 1.2e-7 of it.
float complementary_error(float x) {
    float z = abs(x);
    float t = 1.0 / (1.0 + 0.5 * z);
    float fit = 0.17087277;
    fit = fit * t - 0.82215223;
    fit = fit * t + 1.48851587;
    fit = fit * t - 1.13520398;
    fit = fit * t + 0.27886807;
    fit = fit * t - 0.18628806;
    fit = fit * t + 0.09678418;
    fit = fit * t + 0.37409196;
    fit = fit * t + 1.00002368;
    fit = fit * t - 1.26551223;
    float tail = t * exp(fit - z * z);
    return choose(x < 0.0, 2.0 - tail, tail);
}
)"};

const ShaderFunction k_hemisphere = {
    "hemisphere_integral",
    R"(/// Returns the integral of a lobe over the hemisphere of which the pole has this cosine to its axis.
float hemisphere_integral(float sharpness, float cosine) {
    float t = sqrt(sharpness) * sharpness * (1.6988 * sharpness + 10.8438) / (sharpness * (sharpness + 6.2201) + 10.2415);
    float tc = max(t * cosine, -80.0);
    float blend = (1.0 - exp(-t - tc)) / ((1.0 - exp(-t)) * (1.0 + exp(-tc)));
    float upper = 6.2831855 * (1.0 - exp(-sharpness)) / sharpness;
    float lower = upper * exp(-sharpness);
    return lower + blend * (upper - lower);
}
)"};

/// One for each kind but `exact`, in their order.
const std::array<Formula, 8> k_formulae = {{
    {"inner_product",
     "by its inner product with a lobe like the cosine (Wang et al. 2009)",
     {"squares", "product", "sum", "scale"},
     R"(    float u = sqrt(max($0 + $1 * cosine, 1.0e-12));
    return $3 * exp(u - $2) * (1.0 - exp(-2.0 * u)) / u;
)",
     {}},
    {"punctual", ", all of it from its axis (Pettineo 2016)", {"integral"}, "    return $0 * max(cosine, 0.0);\n", {}},
    {"hill",
     "by Hill's fit (Pettineo 2016)",
     {"scale", "bias", "knee", "slope", "integral"},
     R"(    float x = 0.36 * cosine;
    float y = choose(abs(x) <= $2, $3 * (x + $2) * (x + $2), clamp(cosine, 0.0, 1.0));
    return $4 * ($0 * y + $1);
)",
     {}},
    {"meder",
     "as a difference of two integrals over the hemisphere (Meder and Bruederlin 2018)",
     {"sharpness", "cosine_sharpness", "product", "difference"},
     R"(    float u = sqrt($2 * max(1.0 + cosine, 0.0) + $3);
    float along = ($0 * cosine + $1) / u;
    float amplitude = exp(-$2 * max(1.0 - cosine, 0.0) / (u + $0 + $1));
    return 32.7080 * amplitude * hemisphere_integral(u, along) - 31.7003 * hemisphere_integral($0, cosine);
)",
     {k_hemisphere}},
    {"tokuyoshi",
     "by an error function (Tokuyoshi 2024)",
     {"t", "tail", "scale", "away", "range"},
     R"(    float tc = $0 * cosine;
    float smooth_part = cosine * complementary_error(-tc) + $1;
    float gauss = exp(-tc * tc) - exp(-$0 * $0);
    return $3 + $4 * (0.5 * smooth_part + $2 * gauss);
)",
     {k_erfc}},
    {"odd_exact",
     ": its odd part, and the root of an even one",
     {"odd", "middle", "fall", "curve", "ends"},
     R"(    float x = cosine * cosine;
    float even = sqrt($1 * exp(-$2 * x) + $4 * x);
    return max($0 * cosine + even, 0.0);
)",
     {}},
    {"odd_exact_2",
     ": its odd part, and the root of an even one",
     {"odd", "middle", "fall", "curve", "ends"},
     R"(    float x = cosine * cosine;
    float even = sqrt($1 * exp(-x * ($2 + $3 * x)) + $4 * x);
    return max($0 * cosine + even, 0.0);
)",
     {}},
    {"polynomial",
     ": its odd part, and a polynomial for the even one",
     {"odd", "q0", "q1", "q2", "q3"},
     R"(    float x = cosine * cosine;
    return $0 * cosine + (($4 * x + $3) * x + $2) * x + $1;
)",
     {}},
}};

/// Constants of a lobe that any formula needs, from its sharpness.
const std::vector<ShaderFunction> k_constants = {
    {"towards", R"(/// Returns the irradiance of a lobe at its axis, over 2 pi.
float towards(float s) {
    float series = 0.5 - s * (0.16666667 - s * (0.041666667 - s * (0.0083333333 - s * 0.0013888889)));
    return choose(s < 0.3, series, (s - 1.0 + exp(-s)) / (s * s));
}
)"},
    {"away", R"(/// Returns the irradiance of a lobe opposite to its axis, over 2 pi.
float away(float s) {
    float series = 0.5 - s * (0.33333333 - s * (0.125 - s * (0.033333333 - s * 0.0069444444)));
    return exp(-s) * choose(s < 0.3, series, (1.0 - exp(-s) * (1.0 + s)) / (s * s));
}
)"}};

const std::vector<ShaderFunction> k_odd_constants = {
    {"across",
     R"(/// Returns the irradiance of a lobe across its axis, over 2 pi: e^-s I_1(s) / s (Abramowitz and Stegun 9.8.3, 9.8.4).
float across(float s) {
    float x = s / 3.75;
    float y = x * x;
    float small = 0.5 + y * (0.87890594 + y * (0.51498869 + y * (0.15084934 + y * (0.02658733 + y * (0.00301532 + y * 0.00032411)))));
    float z = 1.0 / max(x, 1.0);
    float large = 0.02282967 + z * (-0.02895312 + z * (0.01787654 - z * 0.00420059));
    large = 0.39894228 + z * (-0.03988024 + z * (-0.00362018 + z * (0.00163801 + z * (-0.01031555 + z * large))));
    return choose(s < 3.75, exp(-s) * small, large / (s * sqrt(max(s, 1.0))));
}
)"},
    {"integral", R"(/// Returns the integral of a lobe over the sphere, over 2 pi.
float integral(float s) {
    float series = 2.0 - s * (2.0 - s * (1.3333333 - s * (0.66666667 - s * (0.26666667 - s * 0.088888889))));
    return choose(s < 0.1, series, (1.0 - exp(-2.0 * s)) / s);
}
)"},
    {"mean_cosine", R"(/// Returns the mean cosine of a lobe to its axis, coth(s) - 1 / s.
float mean_cosine(float s) {
    float y = s * s;
    float series = s * (0.33333333 - y * (0.022222222 - y * (0.0021164021 - y * 0.00021164021)));
    float decay = exp(-2.0 * s);
    return choose(s < 0.5, series, (1.0 + decay) / (1.0 - decay) - 1.0 / max(s, 0.5));
}
)"}};

/// The beginning of lobe_irradiance.
constexpr std::string_view k_fitted_head = R"(float lobe_irradiance(vec3 axis, vec3 n) {
    float s = clamp(length(axis), 1.0e-6, 10000.0);
    float cosine = dot(axis, n) / max(length(axis), 1.0e-6);
)";

constexpr std::string_view k_fitted_tokuyoshi =
    R"(    float t = s * sqrt(((s + 2.73608316113) * s + 17.0212977817) / (2.0 * (((s + 4.01008267285) * s + 15.2191562631) * s + 76.0878962724)));
    float dark = 6.2831855 * away(s);
    return tokuyoshi(cosine, t, complementary_error(t), 0.28209479 / t, dark, 6.2831855 * towards(s) - dark);
}
)";

constexpr std::string_view k_fitted_odd = R"(    float whole = integral(s);
    float middle = across(s) / whole;
    float ends = 0.5 * (towards(s) + away(s)) / whole;
    whole *= 6.2831855;
    float slope = ends * ends - middle * middle * exp(-fall - curve);
    return $0(cosine, 0.5 * whole * mean_cosine(s), whole * whole * middle * middle, fall, curve, whole * whole * slope);
}
)";

constexpr std::string_view k_fall_1 =
    R"(    float fall = s * s * (0.15544454 + s * (0.02048363 + 0.0067609595 * s)) / (1.0 + s * (0.16346704 + s * (0.04498634 + 0.0119663 * s)));
    float curve = 0.0;
)";
constexpr std::string_view k_fall_2 =
    R"(    float fall = s * s * (0.17497065 + s * (0.05765063 + 0.034785649 * s)) / (1.0 + s * (0.38770256 + s * (0.15044952 + 0.06156752 * s)));
    float curve = 0.0042626988 * s * s * s / (1.0 + s * (-0.1534013437 + s * (0.0324566805 + s * 0.00061038514)));
)";

ShaderFunction function_of(const Formula& formula, const std::vector<std::string>& values,
                           const std::string& parameters) {
    std::string body;
    for (std::size_t i = 0; i < formula.body.size(); ++i)
        if (formula.body[i] == '$')
            body += values[static_cast<std::size_t>(formula.body[++i] - '0')];
        else
            body += formula.body[i];
    const bool joined = formula.comment.front() == ',' || formula.comment.front() == ':';
    return {std::string(formula.name), "/// Returns the irradiance of a lobe" + std::string(joined ? "" : " ") +
                                           std::string(formula.comment) + ".\nfloat " + std::string(formula.name) +
                                           "(float cosine" + parameters + ") {\n" + body + "}\n"};
}

}  // namespace

const Formula& formula_of(SgIrradiance kind) { return k_formulae[static_cast<std::size_t>(kind)]; }

std::vector<ShaderFunction> with_constants(const Formula& formula, const std::vector<std::string>& constants) {
    std::vector<ShaderFunction> list = formula.functions;
    list.push_back(function_of(formula, constants, ""));
    return list;
}

std::vector<ShaderFunction> with_parameters(const Formula& formula) {
    std::vector<ShaderFunction> list = formula.functions;
    std::string parameters;
    for (const std::string_view name : formula.constants) parameters += ", float " + std::string(name);
    list.push_back(function_of(formula, {formula.constants.begin(), formula.constants.end()}, parameters));
    return list;
}

Result<std::vector<ShaderFunction>> fitted_functions(SgIrradiance kind) {
    std::string body;
    if (kind == SgIrradiance::tokuyoshi)
        body = k_fitted_tokuyoshi;
    else if (kind == SgIrradiance::odd_exact)
        body = std::string(k_fall_1) + shader_text::filled(k_fitted_odd, {"odd_exact"});
    else if (kind == SgIrradiance::odd_exact_2)
        body = std::string(k_fall_2) + shader_text::filled(k_fitted_odd, {"odd_exact_2"});
    else
        return Error{
            "the constants of this evaluator are made for a sharpness that is known before: a shader that "
            "finds it in the coefficients cannot have them; use odd-exact-2"};
    std::vector<ShaderFunction> list = with_parameters(formula_of(kind));
    list.insert(list.end(), k_constants.begin(), k_constants.end());
    if (kind != SgIrradiance::tokuyoshi) list.insert(list.end(), k_odd_constants.begin(), k_odd_constants.end());
    list.push_back(
        {"lobe_irradiance", "/// Returns the irradiance of a lobe; `axis` is its axis times its sharpness.\n" +
                                std::string(k_fitted_head) + body});
    return list;
}

}  // namespace lobelia::sg_shader
