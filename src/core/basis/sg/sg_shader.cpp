// Shader code of spherical Gaussians on fixed axes: one function for a lobe, called once for each.
#include "core/basis/sg/sg_shader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/basis/direction_text.h"
#include "core/basis/sg/sg_formulae.h"
#include "core/math/shader_text.h"

namespace lobelia::sg_shader {
namespace {

using shader_text::literal;

using Constants = std::vector<double>;

/// The constants that all lobes but ambient ones share; null if they differ.
const Constants* shared_constants(const std::vector<Constants>& constants) {
    const Constants* shared = nullptr;
    for (const auto& of_lobe : constants) {
        if (of_lobe.empty()) continue;
        if (shared != nullptr && *shared != of_lobe) return nullptr;
        shared = &of_lobe;
    }
    return shared;
}

/// "name(first, 0.5, 2.0)"; `constants` may be null.
std::string call(const std::string& name, const std::string& first, const Constants* constants) {
    std::string text = name + "(" + first;
    if (constants != nullptr)
        for (const auto& constant : literals(*constants)) text += ", " + constant;
    return text + ")";
}

std::string cosine_to(const Lobe& lobe, const std::string& direction) {
    return shader_text::dot_product(direction, lobe.axis);
}

/// The irradiance of a lobe as (odd, a_0, a_1, ...): odd c + sum of a_k T_k(2 c^2 - 1), c the cosine, T_k Chebyshev's
/// polynomials. `k` holds the triples (term, ...) of its Legendre series, of which the only odd term is the first.
Constants chebyshev_series(std::span<const float> k) {
    std::vector<double> even;
    for (std::size_t l = 0; 3 * l < k.size(); ++l) even.push_back(l % 2 == 0 ? static_cast<double>(k[3 * l]) : 0);
    const std::size_t count = (even.size() + 1) / 2;
    Constants series = {k.size() > 3 ? static_cast<double>(k[3]) : 0};
    series.resize(1 + count);
    for (std::size_t node = 0; node < count; ++node) {
        const double angle = k_pi * (static_cast<double>(node) + 0.5) / static_cast<double>(count);
        const double value = gaussian::zonal_sum(even, std::cos(angle / 2)) / static_cast<double>(count);
        for (std::size_t i = 0; i < count; ++i)
            series[1 + i] += (i == 0 ? value : 2 * value * std::cos(static_cast<double>(i) * angle));
    }

    // Leave out what float32 does not see; the integral is four times the first term.
    while (series.size() > 2 && std::abs(series.back()) < 1e-8 * 4 * k[0]) series.pop_back();
    return series;
}

/// Clenshaw's sum of chebyshev_series, unrolled.
ShaderFunction series_function(const std::string& name, std::span<const float> constants) {
    const Constants series = chebyshev_series(constants);
    const auto a = [&](std::size_t i) { return literal(series[1 + i]); };
    const auto b = [&](std::size_t i) { return i + 2 == series.size() ? a(i) : "b" + std::to_string(i); };
    const std::size_t count = series.size() - 1;
    std::string body;
    if (count > 1) body += "    float y = 2.0 * cosine * cosine - 1.0;\n";
    for (std::size_t i = count - 1; i-- > 1;)
        body += "    float " + b(i) + " = " + a(i) + " + 2.0 * y * " + b(i + 1) +
                (i + 2 < count ? " - " + b(i + 2) : "") + ";\n";
    body += "    return " + literal(series[0]) + " * cosine + " + a(0) + (count > 1 ? " + y * " + b(1) : "") +
            (count > 2 ? " - " + b(2) : "") + ";\n";
    join_signs(body);
    return {name,
            "/// Returns the irradiance of a lobe: its odd part, and a Chebyshev series for the even one (Clenshaw "
            "1955).\nfloat " +
                name + "(float cosine) {\n" + body + "}\n"};
}

/// Irradiance with a function for each kind of lobe: make(name, constants) writes it.
template <class Make>
ShaderCode irradiance_by_kinds(const std::string& name, std::span<const Lobe> lobes,
                               const std::vector<std::vector<float>>& constants, const Make& make) {
    std::vector<std::vector<float>> kinds;
    for (const auto& k : constants)
        if (!k.empty() && std::find(kinds.begin(), kinds.end(), k) == kinds.end()) kinds.push_back(k);
    const auto name_of = [&](std::size_t kind) { return kinds.size() == 1 ? name : name + "_" + std::to_string(kind); };
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const auto kind = static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), constants[i]) - kinds.begin());
        weights.push_back(constants[i].empty() ? literal(k_pi)
                                               : call(name_of(kind), cosine_to(lobes[i], "n"), nullptr));
    }
    ShaderCode code = shader_text::sum_of(weights, "e");
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) code.functions.push_back(make(name_of(kind), kinds[kind]));
    return code;
}

/// Whether float32 knows sharpness * (cosine - 1) well enough: the cosine is off by 1.2e-7, and by the axis's length.
bool is_soft(const Lobe& lobe) {
    double squared = 0;
    for (const double x : {lobe.axis.x, lobe.axis.y, lobe.axis.z}) squared += x * x;
    return lobe.sharpness * (1.2e-7 + std::abs(squared - 1) / 2) < 6e-6;
}

/// The function of one lobe: `value` is its sharpness, `half` minus half of it.
ShaderFunction lobe_function(bool soft, const std::string& value, const std::string& half,
                             const std::string& parameters) {
    if (soft)
        return {"lobe", "/// Returns a spherical Gaussian at a cosine to its axis.\nfloat lobe(float cosine" +
                            parameters + ") {\n    return exp(" + value + " * (cosine - 1.0));\n}\n"};
    return {"lobe",
            "/// Returns a spherical Gaussian. The distance to the axis is more precise than the cosine.\n"
            "float lobe(vec3 w, vec3 axis" +
                parameters + ") {\n    vec3 d = w - axis;\n    return exp(" + half + " * dot(d, d));\n}\n"};
}

}  // namespace

ShaderCode radiance(std::span<const Lobe> lobes) {
    std::vector<Constants> sharpness;
    bool soft = true, all_ambient = true;
    for (const Lobe& lobe : lobes) {
        const bool ambient = lobe.sharpness == 0;
        sharpness.push_back(ambient ? Constants() : Constants{lobe.sharpness});
        soft = soft && (ambient || is_soft(lobe));
        all_ambient = all_ambient && ambient;
    }
    const Constants* shared = shared_constants(sharpness);
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        const std::string place = soft ? cosine_to(lobes[i], "w") : "w, " + literal(lobes[i].axis);
        weights.push_back(sharpness[i].empty() ? "1.0" : call("lobe", place, shared ? nullptr : &sharpness[i]));
    }
    ShaderCode code = shader_text::sum_of(weights, "sum");
    if (shared)
        code.functions = {lobe_function(soft, literal(shared->front()), literal(-0.5 * shared->front()), "")};
    else if (!all_ambient)
        code.functions = {lobe_function(soft, "sharpness", "-0.5 * sharpness", ", float sharpness")};
    return code;
}

ShaderCode irradiance(SgIrradiance kind, std::span<const Lobe> lobes,
                      const std::vector<std::vector<float>>& constants) {
    if (kind == SgIrradiance::exact) return irradiance_by_kinds("series", lobes, constants, series_function);
    std::vector<Constants> all;
    float least_sharpness = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        all.push_back(constants[i].empty() ? Constants() : folded(kind, constants[i]));
        if (!constants[i].empty()) least_sharpness = std::min(least_sharpness, lobes[i].sharpness);
    }
    if (kind == SgIrradiance::meder) {
        ShaderCode code = irradiance_by_kinds("meder", lobes, constants, meder_function);
        const auto called = functions_of(kind, least_sharpness);
        if (!code.functions.empty()) code.functions.insert(code.functions.begin(), called.begin(), called.end());
        return code;
    }
    const Constants* shared = shared_constants(all);
    const Formula& formula = formula_of(kind);
    const bool factored = shared != nullptr && has_factor(formula);
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < lobes.size(); ++i)
        weights.push_back(all[i].empty()
                              ? literal(k_pi / (factored ? shared->front() : 1))
                              : call(std::string(formula.name), cosine_to(lobes[i], "n"), shared ? nullptr : &all[i]));
    ShaderCode code = shader_text::sum_of(weights, "e");
    if (factored) code.result = literal(shared->front()) + " * e";
    if (std::isinf(least_sharpness)) return code;
    code.functions = functions_of(kind, least_sharpness);
    code.functions.push_back(shared ? with_constants(formula, literals(*shared)) : with_parameters(formula));
    return code;
}

ShaderCode fitted_radiance(std::size_t count) {
    ShaderCode code{{}, {}, "sum"};
    code.functions.push_back(
        {"lobe",
         "/// Returns a spherical Gaussian; `axis` is its axis times its sharpness, of which 10000 is the most.\n"
         "float lobe(vec3 axis, vec3 w) {\n"
         "    float sharpness = length(axis);\n"
         "    // The distance to the axis is more precise than the cosine.\n"
         "    vec3 d = w - axis / max(sharpness, 1.0e-6);\n"
         "    return exp(-0.5 * min(sharpness, 10000.0) * dot(d, d));\n}\n"});
    for (std::size_t i = 0; i < count; ++i)
        code.statements += std::string("    ") + (i == 0 ? "vec3 sum = " : "sum += ") +
                           shader_text::coefficient(2 * i) + " * lobe(" + shader_text::coefficient(2 * i + 1) +
                           ", w);\n";
    return code;
}

Result<ShaderCode> fitted_irradiance(SgIrradiance kind, std::size_t count) {
    auto functions = fitted_functions(kind);
    if (!functions) return functions.error();
    ShaderCode code{*std::move(functions), {}, "e"};
    for (std::size_t i = 0; i < count; ++i)
        code.statements += std::string("    ") + (i == 0 ? "vec3 e = " : "e += ") + shader_text::coefficient(2 * i) +
                           " * lobe_irradiance(" + shader_text::coefficient(2 * i + 1) + ", n);\n";
    return code;
}

}  // namespace lobelia::sg_shader
