// The formulae of irradiance of a spherical Gaussian, as shader code; sg_irradiance.cpp has the same for lanes.
// Wang et al. 2009; Pettineo 2016 (parts 3 and 4; the fit by S. Hill); Meder and Bruederlin 2018; Tokuyoshi 2024.
// Abramowitz and Stegun 1964 (9.8.3, 9.8.4: the Bessel function I_1).
#include "core/basis/sg/sg_formulae.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/math/shader_text.h"

namespace lobelia::sg_shader {
namespace {

using shader_text::literal;

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

/// From this sharpness on, .0315 is a small change of it.
constexpr double k_least_expanded = 1;

const ShaderFunction k_tanh = {"hyperbolic_tangent", R"(/// Returns tanh(x), off by at most 2e-7.
float hyperbolic_tangent(float x) {
    return 1.0 - 2.0 / (exp(min(2.0 * x, 80.0)) + 1.0);
}
)"};
const ShaderFunction k_precise_tanh = {"hyperbolic_tangent", R"(/// Returns tanh(x), off by at most 3e-7 of it.
float hyperbolic_tangent(float x) {
    float y = x * x;
    float fraction = x * (945.0 + y * (105.0 + y)) / (945.0 + y * (420.0 + 15.0 * y));
    return choose(y < 1.0, fraction, 1.0 - 2.0 / (exp(min(2.0 * x, 80.0)) + 1.0));
}
)"};

/// The blend of the library's formula, a logistic, is (1 + tanh(t cosine) / tanh(t)) / 2.
const ShaderFunction k_hemisphere = {
    "hemisphere_integral",
    R"(/// Returns the integral of a lobe over the hemisphere of which the pole has this cosine to its axis.
float hemisphere_integral(float sharpness, float cosine) {
    float t = sqrt(sharpness) * sharpness * (0.8494 * sharpness + 5.4219) / (sharpness * (sharpness + 6.2201) + 10.2415);
    float a = hyperbolic_tangent(0.5 * sharpness);
    float mean = 12.566371 * a / (sharpness * (1.0 + a) * (1.0 + a));
    return mean + mean * a * hyperbolic_tangent(t * cosine) / hyperbolic_tangent(t);
}
)"};

/// One for each kind but `exact`, in their order.
const std::array<Formula, 8> k_formulae = {{
    {"inner_product",
     "by its inner product with a lobe like the cosine (Wang et al. 2009)",
     {"scale", "squares", "product", "sum"},
     R"(    float u = sqrt(max($1 + $2 * cosine, 1.0e-12));
    return @exp(u - $3) * (1.0 - exp(-2.0 * u)) / u;
)",
     {}},
    {"punctual", ", all of it from its axis (Pettineo 2016)", {"integral"}, "    return @max(cosine, 0.0);\n", {}},
    {"hill",
     "by Hill's fit (Pettineo 2016)",
     {"scale", "bias", "knee", "slope"},
     R"(    float y = choose(abs(cosine) <= $2, $3 * (cosine + $2) * (cosine + $2), clamp(cosine, 0.0, 1.0));
    return $0 * y + $1;
)",
     {}},
    {"meder",
     "as a difference of two integrals over the hemisphere (Meder and Bruederlin 2018)",
     {"sharpness", "product", "difference", "sum", "mean", "swing", "t"},
     R"(    float u = sqrt($1 * max(1.0 + cosine, 0.0) + $2);
    float along = ($0 * cosine + 0.0315) / u;
    float amplitude = 32.708 * exp(-$1 * max(1.0 - cosine, 0.0) / (u + $3));
    return amplitude * hemisphere_integral(u, along) - $4 - $5 * hyperbolic_tangent($6 * cosine);
)",
     {k_precise_tanh, k_hemisphere}},
    {"tokuyoshi",
     "by an error function (Tokuyoshi 2024)",
     {"t", "base", "slope", "peak"},
     R"(    float tc = $0 * cosine;
    return $1 + $2 * cosine * complementary_error(-tc) + $3 * exp(-tc * tc);
)",
     {k_erfc}},
    {"odd_exact",
     ": its odd part, and the root of an even one",
     {"odd", "middle", "fall", "ends"},
     R"(    float x = cosine * cosine;
    float even = sqrt($1 * exp(-$2 * x) + $3 * x);
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

const ShaderFunction k_across = {
    "across",
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
)"};

/// The beginning of lobe_irradiance.
constexpr std::string_view k_fitted_head = R"(float lobe_irradiance(vec3 axis, vec3 n) {
    float s = clamp(length(axis), 1.0e-6, 10000.0);
    float cosine = dot(axis, n) / max(length(axis), 1.0e-6);
)";

constexpr std::string_view k_fitted_tokuyoshi =
    R"(    float t = s * sqrt(((s + 2.7360832) * s + 17.021298) / (2.0 * (((s + 4.0100827) * s + 15.219156) * s + 76.087896)));
    float dark = 6.2831855 * away(s);
    float slope = 3.1415927 * towards(s) - 0.5 * dark;
    float peak = 0.56418958 * slope / t;
    float base = dark + slope * complementary_error(t) - peak * exp(-t * t);
    return tokuyoshi(cosine, t, base, slope, peak);
}
)";

/// The odd part is exactly half the difference of the irradiances at the axis and opposite to it, times the cosine.
constexpr std::string_view k_fitted_odd = R"(    float bright = 3.1415927 * towards(s);
    float dark = 3.1415927 * away(s);
    float middle = 6.2831855 * across(s);
    middle *= middle;
)";
constexpr std::string_view k_fitted_odd_1 =
    R"(    float ends = (bright + dark) * (bright + dark) - middle * exp(-fall);
    return odd_exact(cosine, bright - dark, middle, fall, ends);
}
)";
constexpr std::string_view k_fitted_odd_2 =
    R"(    float ends = (bright + dark) * (bright + dark) - middle * exp(-fall - curve);
    return odd_exact_2(cosine, bright - dark, middle, fall, curve, ends);
}
)";

constexpr std::string_view k_fall_1 =
    R"(    float fall = s * s * (0.15544454 + s * (0.02048363 + 0.0067609595 * s)) / (1.0 + s * (0.16346704 + s * (0.04498634 + 0.0119663 * s)));
)";
constexpr std::string_view k_fall_2 =
    R"(    float fall = s * s * (0.17497065 + s * (0.05765063 + 0.034785649 * s)) / (1.0 + s * (0.38770256 + s * (0.15044952 + 0.06156752 * s)));
    float curve = 0.0042626988 * s * s * s / (1.0 + s * (-0.1534013437 + s * (0.0324566805 + s * 0.00061038514)));
)";

ShaderFunction function_of(const Formula& formula, const std::vector<std::string>& values,
                           const std::string& parameters, const std::string& factor) {
    std::string body;
    for (std::size_t i = 0; i < formula.body.size(); ++i)
        if (formula.body[i] == '$')
            body += values[static_cast<std::size_t>(formula.body[++i] - '0')];
        else if (formula.body[i] == '@')
            body += factor;
        else
            body += formula.body[i];
    join_signs(body);
    const bool joined = formula.comment.front() == ',' || formula.comment.front() == ':';
    return {std::string(formula.name),
            "/// Returns the irradiance of a lobe" + std::string(joined ? "" : " ") + std::string(formula.comment) +
                (has_factor(formula) && factor.empty() ? "; its caller scales it" : "") + ".\nfloat " +
                std::string(formula.name) + "(float cosine" + parameters + ") {\n" + body + "}\n"};
}

/// The cosine's sharpness in Meder and Bruederlin's difference: max(0, cos) is about 32.7080 SG(.0315) - 31.7003.
constexpr double k_cosine_sharpness = 0.0315;

/// The integral of a lobe over the hemisphere is mean + swing tanh(rate s cosine).
struct HemisphereIntegral {
    double mean, swing, rate;
    explicit HemisphereIntegral(double s) {
        const double a = std::tanh(s / 2);
        rate = std::sqrt(s) * (0.8494 * s + 5.4219) / (s * (s + 6.2201) + 10.2415);
        mean = 4 * k_pi * a / (s * (1 + a) * (1 + a));
        swing = mean * a / std::tanh(rate * s);
    }
};

/// The code of f(s + d) - f(s), |d| <= .0315: d times the parabola through the slopes at three Chebyshev nodes.
std::string change_text(double s, double HemisphereIntegral::*f) {
    const double h = k_cosine_sharpness * std::sqrt(0.75), nearly_0 = 1e-3 * h;
    const auto slope = [&](double d) { return (HemisphereIntegral(s + d).*f - HemisphereIntegral(s).*f) / d; };
    const double middle = (slope(nearly_0) + slope(-nearly_0)) / 2;
    const double linear = (slope(h) - slope(-h)) / (2 * h), square = (slope(h) + slope(-h) - 2 * middle) / (2 * h * h);
    return "d * (" + literal(middle) + " + d * (" + literal(linear) + " + " + literal(square) + " * d))";
}

/// Meder and Bruederlin's formula without the cancellation of its two integrals, of which the difference is 1/65: the
/// product has the sharpness s + d, |d| <= .0315.
constexpr std::string_view k_meder_body =
    R"(    // The product with the cosine's lobe: its sharpness is larger by d, its amplitude by `fade`.
    float u = sqrt($0 * max(1.0 + cosine, 0.0) + $1);
    float d = ($0 * cosine + 0.00099225) / (u + $2);
    float x = $0 * max(1.0 - cosine, 0.0) / (u + $3);
    float fade = -x * (1.0 - x * (0.5 - x * (0.16666667 - 0.041666667 * x)));
    // The integral of the lobe over the hemisphere, and how much more that of the product is.
    float blend = hyperbolic_tangent($4 * cosine);
    float v = $5 + $6 * ($2 * cosine + 0.0315);
    v *= 1.0 - 0.33333333 * v * v;
    float rise = v * (1.0 - blend * blend) / (1.0 + blend * v);
    float whole = $7 + $8 * blend;
    float change = $9 + $8 * rise + @ * (blend + rise);
    return 1.0077 * whole + 32.708 * (fade * whole + (1.0 + fade) * change);
)";

}  // namespace

void join_signs(std::string& text) {
    for (const auto& [from, to] : {std::pair{"+ -", "- "}, std::pair{"- -", "+ "}})
        for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += 2) text.replace(at, 3, to);
}

const Formula& formula_of(SgIrradiance kind) { return k_formulae[static_cast<std::size_t>(kind)]; }

bool has_factor(const Formula& formula) { return formula.body.find('@') != std::string_view::npos; }

std::vector<double> folded(SgIrradiance kind, std::span<const float> constants) {
    const std::vector<double> k(constants.begin(), constants.end());
    switch (kind) {
        case SgIrradiance::inner_product:
            return {k[3], k[0], k[1], k[2]};
        case SgIrradiance::hill:
            return {k[4] * k[0], k[4] * k[1], k[2] / 0.36, k[3] * 0.36 * 0.36};
        case SgIrradiance::meder: {
            const HemisphereIntegral lobe(k[0]);
            return {k[0], k[2], k[3], k[0] + k[1], 31.7003 * lobe.mean, 31.7003 * lobe.swing, lobe.rate * k[0]};
        }
        case SgIrradiance::tokuyoshi: {
            const double t = k[0], peak = k[4] * k[2];
            return {t, k[3] + k[4] * k[1] / 2 - peak * std::exp(-t * t), k[4] / 2, peak};
        }
        case SgIrradiance::odd_exact:
            return {k[0], k[1], k[2], k[4]};
        default:
            return k;
    }
}

std::vector<ShaderFunction> functions_of(SgIrradiance kind, float least_sharpness) {
    if (kind == SgIrradiance::meder && least_sharpness >= k_least_expanded) return {k_tanh};
    return formula_of(kind).functions;
}

ShaderFunction meder_function(const std::string& name, std::span<const float> constants) {
    const double s = constants[0];
    Formula formula = formula_of(SgIrradiance::meder);
    formula.name = name;
    if (s < k_least_expanded) return with_constants(formula, literals(folded(SgIrradiance::meder, constants)));
    const HemisphereIntegral lobe(s);
    const double difference = s - k_cosine_sharpness;
    formula.body = k_meder_body;
    return function_of(formula,
                       {literal(2 * s * k_cosine_sharpness), literal(difference * difference), literal(s),
                        literal(s + k_cosine_sharpness), literal(lobe.rate * s),
                        literal(lobe.rate * k_cosine_sharpness), change_text(s, &HemisphereIntegral::rate),
                        literal(lobe.mean), literal(lobe.swing), change_text(s, &HemisphereIntegral::mean)},
                       "", change_text(s, &HemisphereIntegral::swing));
}

std::vector<std::string> literals(std::span<const double> values) {
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(literal(value));
    return texts;
}

ShaderFunction with_constants(const Formula& formula, const std::vector<std::string>& constants) {
    return function_of(formula, constants, "", "");
}

ShaderFunction with_parameters(const Formula& formula) {
    std::string parameters;
    for (const std::string_view name : formula.constants) parameters += ", float " + std::string(name);
    return function_of(formula, {formula.constants.begin(), formula.constants.end()}, parameters,
                       std::string(formula.constants[0]) + " * ");
}

Result<std::vector<ShaderFunction>> fitted_functions(SgIrradiance kind) {
    std::string body;
    if (kind == SgIrradiance::tokuyoshi)
        body = k_fitted_tokuyoshi;
    else if (kind == SgIrradiance::odd_exact)
        body = std::string(k_fall_1).append(k_fitted_odd).append(k_fitted_odd_1);
    else if (kind == SgIrradiance::odd_exact_2)
        body = std::string(k_fall_2).append(k_fitted_odd).append(k_fitted_odd_2);
    else
        return Error{
            "this evaluator is a series whose terms, and their number, depend on the sharpness, which a shader finds "
            "only in the coefficients; use odd-exact-2"};
    std::vector<ShaderFunction> list = formula_of(kind).functions;
    list.push_back(with_parameters(formula_of(kind)));
    list.insert(list.end(), k_constants.begin(), k_constants.end());
    if (kind != SgIrradiance::tokuyoshi) list.push_back(k_across);
    list.push_back(
        {"lobe_irradiance", "/// Returns the irradiance of a lobe; `axis` is its axis times its sharpness.\n" +
                                std::string(k_fitted_head) + body});
    return list;
}

}  // namespace lobelia::sg_shader
