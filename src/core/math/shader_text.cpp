#include "core/math/shader_text.h"

#include <charconv>

namespace lobelia::shader_text {

std::string literal(float value) {
    char buffer[32];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    std::string text(buffer, end);
    // A point makes it a float in every language.
    if (text.find_first_of(".n") == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
    return text;
}

std::string literal(Vec3 v) { return "vec3(" + literal(v.x) + ", " + literal(v.y) + ", " + literal(v.z) + ")"; }

std::string literal(double x, double y, double z) {
    return literal(Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

std::string coefficient(std::size_t i) { return "light.c[" + std::to_string(i) + "]"; }

namespace {

/// Whether a scalar expression is computed before it is a factor: it has an operator outside of brackets.
bool has_operator(const std::string& expression) {
    int depth = 0;
    for (std::size_t i = 0; i < expression.size(); ++i) {
        if (expression[i] == '(') ++depth;
        if (expression[i] == ')') --depth;
        if (depth == 0 && expression[i] == ' ') return true;
    }
    return false;
}

}  // namespace

ShaderCode sum_of(std::span<const std::string> weights, const std::string& name) {
    ShaderCode code{{}, {}, name};
    for (std::size_t i = 0; i < weights.size(); ++i) {
        std::string term = coefficient(i);
        if (weights[i] != "1.0") term += " * " + (has_operator(weights[i]) ? "(" + weights[i] + ")" : weights[i]);
        code.statements += "    " + ((i == 0 ? "vec3 " + name + " = " : name + " += ") + term) + ";\n";
    }
    return code;
}

}  // namespace lobelia::shader_text
