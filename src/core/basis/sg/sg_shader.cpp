// Shader code of spherical Gaussians on fixed axes: one function for a lobe, called once for each.
#include "core/basis/sg/sg_shader.h"

#include <algorithm>

#include "core/basis/direction_text.h"
#include "core/basis/sg/sg_formulae.h"
#include "core/math/shader_text.h"

namespace lobelia::sg_shader {
namespace {

using shader_text::literal;

/// The constants that all lobes but ambient ones share; null if they differ.
const std::vector<float>* shared_constants(const std::vector<std::vector<float>>& constants) {
    const std::vector<float>* shared = nullptr;
    for (const auto& of_lobe : constants) {
        if (of_lobe.empty()) continue;
        if (shared != nullptr && *shared != of_lobe) return nullptr;
        shared = &of_lobe;
    }
    return shared;
}

std::vector<std::string> literals(std::span<const float> values) {
    std::vector<std::string> texts;
    for (const float value : values) texts.push_back(literal(value));
    return texts;
}

/// The arguments of a call: the cosine, and the constants if they are parameters.
std::string arguments(const Lobe& lobe, const std::string& direction, std::span<const float> constants) {
    std::string text = shader_text::dot_product(direction, lobe.axis);
    for (const float constant : constants) text += ", " + literal(constant);
    return text;
}

/// Clenshaw's sum of a Legendre series, unrolled; `k` holds the triples (term, (2l + 1) / (l + 1), (l + 1) / (l + 2)).
ShaderFunction series_function(const std::string& name, std::span<const float> k) {
    const std::size_t terms = k.size() / 3;
    std::string body;
    for (std::size_t l = terms; l-- > 0;) {
        const auto b = [](std::size_t i) { return "b" + std::to_string(i); };
        std::string sum = literal(k[3 * l]);
        if (l + 1 < terms) sum += " + " + literal(k[3 * l + 1]) + " * cosine * " + b(l + 1);
        if (l + 2 < terms) sum += " - " + literal(k[3 * l + 2]) + " * " + b(l + 2);
        body += l == 0 ? "    return " + sum + ";\n" : "    float " + b(l) + " = " + sum + ";\n";
    }
    return {name, "/// Returns the irradiance of a lobe: the sum of its Legendre series (Clenshaw 1955).\nfloat " +
                      name + "(float cosine) {\n" + body + "}\n"};
}

/// Irradiance by series, a function for each kind of lobe.
ShaderCode series_irradiance(std::span<const Lobe> lobes, const std::vector<std::vector<float>>& constants) {
    const bool one = shared_constants(constants) != nullptr;
    std::vector<ShaderFunction> functions;
    std::vector<const std::vector<float>*> known;
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        if (constants[i].empty()) {
            weights.push_back(literal(k_pi));
            continue;
        }
        const auto same = std::find_if(known.begin(), known.end(), [&](const auto* k) { return *k == constants[i]; });
        const std::string name = one ? "series" : "series_" + std::to_string(same - known.begin());
        if (same == known.end()) {
            known.push_back(&constants[i]);
            functions.push_back(series_function(name, constants[i]));
        }
        weights.push_back(name + "(" + arguments(lobes[i], "n", {}) + ")");
    }
    ShaderCode code = shader_text::sum_of(weights, "e");
    code.functions = std::move(functions);
    return code;
}

}  // namespace

ShaderCode radiance(std::span<const Lobe> lobes) {
    std::vector<std::vector<float>> sharpness;
    for (const Lobe& lobe : lobes) {
        sharpness.emplace_back();
        if (lobe.sharpness > 0) sharpness.back().push_back(lobe.sharpness);
    }
    const auto* shared = shared_constants(sharpness);
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < lobes.size(); ++i)
        weights.push_back(sharpness[i].empty() ? "1.0"
                                               : "lobe(" +
                                                     arguments(lobes[i], "w",
                                                               shared ? std::span<const float>()
                                                                      : std::span<const float>(sharpness[i])) +
                                                     ")");
    ShaderCode code = shader_text::sum_of(weights, "sum");
    const std::string value = shared ? literal(shared->front()) : "sharpness";
    if (std::any_of(sharpness.begin(), sharpness.end(), [](const auto& k) { return !k.empty(); }))
        code.functions.push_back(
            {"lobe", std::string("/// Returns a spherical Gaussian at a cosine to its axis.\n") +
                         (shared ? "float lobe(float cosine) {\n" : "float lobe(float cosine, float sharpness) {\n") +
                         "    return exp(" + value + " * (cosine - 1.0));\n}\n"});
    return code;
}

ShaderCode irradiance(SgIrradiance kind, std::span<const Lobe> lobes,
                      const std::vector<std::vector<float>>& constants) {
    if (kind == SgIrradiance::exact) return series_irradiance(lobes, constants);
    const auto* shared = shared_constants(constants);
    const Formula& formula = formula_of(kind);
    std::vector<std::string> weights;
    for (std::size_t i = 0; i < lobes.size(); ++i)
        weights.push_back(constants[i].empty() ? literal(k_pi)
                                               : std::string(formula.name) + "(" +
                                                     arguments(lobes[i], "n",
                                                               shared ? std::span<const float>()
                                                                      : std::span<const float>(constants[i])) +
                                                     ")");
    ShaderCode code = shader_text::sum_of(weights, "e");
    if (std::any_of(constants.begin(), constants.end(), [](const auto& k) { return !k.empty(); }))
        code.functions = shared ? with_constants(formula, literals(*shared)) : with_parameters(formula);
    return code;
}

ShaderCode fitted_radiance(std::size_t count) {
    ShaderCode code{{}, {}, "sum"};
    code.functions.push_back({"lobe",
                              "/// Returns a spherical Gaussian of `axis`, which is its axis times its sharpness.\n"
                              "float lobe(vec3 axis, vec3 w) {\n"
                              "    float sharpness = length(axis);\n"
                              "    float along = dot(axis, w);\n"
                              "    // Above a sharpness of 10000 the axis alone counts.\n"
                              "    float scale = min(1.0, 10000.0 / max(sharpness, 1.0));\n"
                              "    return exp(scale * (along - sharpness));\n}\n"});
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
