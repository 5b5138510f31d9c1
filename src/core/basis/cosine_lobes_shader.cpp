// Shader code of cosine lobes: cosines of three axes at a time are a vec3, and those of the opposite axes its negative.
#include "core/basis/cosine_lobes_shader.h"

#include "core/basis/direction_text.h"
#include "core/math/shader_text.h"

namespace lobelia::cosine_lobes {
namespace {

using shader_text::literal;

constexpr std::array k_components = {".x", ".y", ".z"};

bool has_opposites(std::span<const Vec3> axes) { return axes.size() % 6 == 0; }

/// The code of the cosines of three axes from `first` on; of every other axis where the opposite ones are between.
std::string cosines(const std::string& direction, std::span<const Vec3> axes, std::size_t first) {
    const std::size_t step = has_opposites(axes) ? 2 : 1;
    return shader_text::dot_products(direction, {axes[first], axes[first + step], axes[first + 2 * step]});
}

std::string declare(const std::string& name, const std::string& value) {
    return "    vec3 " + name + " = " + value + ";\n";
}

/// Declares the cosines as `name`, unless they are the components of the direction; returns what to call them.
std::string declare_cosines(const std::string& name, const std::string& value, const std::string& direction,
                            std::string& statements) {
    if (value == direction) return direction;
    statements += declare(name, value);
    return name;
}

/// Adds up coefficients times the values of a function of the cosines of three axes.
ShaderCode sum_of_calls(const std::string& function, const std::string& direction, std::span<const Vec3> axes,
                        const std::string& sum) {
    // Compute the weights of three lobes at a time, and of the opposite ones.
    std::string statements;
    std::vector<std::string> weights(axes.size());
    const std::size_t step = has_opposites(axes) ? 2 : 1;
    for (std::size_t first = 0; first < axes.size(); first += 3 * step) {
        const std::string number = axes.size() > 6 ? "_" + std::to_string(first / 6) : "";
        const std::string facing =
            declare_cosines("facing" + number, cosines(direction, axes, first), direction, statements);
        for (std::size_t side = 0; side < step; ++side) {
            const std::string name = (side == 0 ? "front" : "back") + number;
            statements += declare(name, function + (side == 0 ? "(" : "(-") + facing + ")");
            for (std::size_t k = 0; k < 3; ++k) weights[first + step * k + side] = name + k_components[k];
        }
    }

    ShaderCode code = shader_text::sum_of(weights, sum);
    code.statements = statements + code.statements;
    return code;
}

ShaderFunction squared_cosines() {
    return {"squared_cosines",
            "/// Returns the squares of the cosines above 0 (McTaggart 2004).\n"
            "vec3 squared_cosines(vec3 cosines) {\n"
            "    vec3 c = max(cosines, vec3(0.0));\n"
            "    return c * c;\n}\n"};
}

ShaderFunction lobe_radiances(CosineLobe lobe) {
    if (lobe.fourth == 0 && lobe.square == 1) return squared_cosines();
    return {"lobe_radiances",
            "/// Returns the radiance of lobes, at the cosines of their axes (Iwanicki and Sloan 2017).\n"
            "vec3 lobe_radiances(vec3 cosines) {\n"
            "    vec3 c = max(cosines, vec3(0.0));\n"
            "    vec3 squared = c * c;\n"
            "    return squared * (" +
                literal(lobe.square) + " + " + literal(lobe.fourth) + " * squared);\n}\n"};
}

ShaderFunction lobe_irradiances(CosineLobe lobe) {
    if (lobe.fourth == 0)
        return {
            "lobe_irradiances",
            "/// Returns the irradiance of squared clamped cosines over their factor, at the cosines of their axes.\n"
            "vec3 lobe_irradiances(vec3 cosines) {\n"
            "    vec3 c = 1.0 + cosines;\n"
            "    return c * c;\n}\n"};
    std::array<std::string, 5> k;
    for (std::size_t i = 0; i < 5; ++i)
        k[i] = literal(std::abs(k_pi * (lobe.square * k_square_irradiance[i] + lobe.fourth * k_fourth_irradiance[i])));
    return {"lobe_irradiances",
            "/// Returns the irradiance of lobes, at the cosines of their axes (Iwanicki and Sloan 2017).\n"
            "vec3 lobe_irradiances(vec3 cosines) {\n"
            "    vec3 squared = cosines * cosines;\n"
            "    return " +
                k[0] + " + squared * (" + k[2] + " - " + k[4] + " * squared) + " + k[1] + " * cosines;\n}\n"};
}

/// pi / 8 (1 + c)^2 is the irradiance of max(0, c)^2.
const std::string& square_factor() {
    static const std::string k_text = literal(k_pi * k_square_irradiance[0]);
    return k_text;
}

}  // namespace

ShaderCode sum_of_squares(std::span<const Vec3> axes, const std::string& direction, const std::string& sum) {
    ShaderCode code = sum_of_calls("squared_cosines", direction, axes, sum);
    code.functions = {squared_cosines()};
    return code;
}

ShaderCode radiance_code(CosineLobe lobe, std::span<const Vec3> axes) {
    const ShaderFunction function = lobe_radiances(lobe);
    ShaderCode code = sum_of_calls(function.name, "w", axes, "sum");
    code.functions = {function};
    return code;
}

ShaderCode exact_code(CosineLobe lobe, std::span<const Vec3> axes) {
    const ShaderFunction function = lobe_irradiances(lobe);
    ShaderCode code = sum_of_calls(function.name, "n", axes, "e");
    code.functions = {function};
    if (lobe.fourth == 0) code.result = literal(lobe.square * k_pi * k_square_irradiance[0]) + " * e";
    return code;
}

ShaderCode squares_code(std::span<const Vec3> axes) {
    // At an axis (1 + c)^2 is 4 for its own lobe, 1 for those across and 0 for the opposite one: the sum of all
    // coefficients, plus three times its own, less the opposite one.
    std::string statements;
    const std::string n = declare_cosines("facing", cosines("n", axes, 0), "n", statements);
    if (has_opposites(axes)) {
        // The squares sum to 1. Those of a side that n faces times 3, those of one behind it times -1: x (x + 2 |x|).
        std::vector<std::string> weights;
        for (const char* component : k_components)
            for (const std::string side : {"front", "back"}) weights.push_back("1.0 + " + side + component);
        ShaderCode code = shader_text::sum_of(weights, "e");
        code.statements = statements +
                          "    // Squared cosines, times 3 for the sides that n faces and times -1 for the others.\n" +
                          declare("front", n + " * (" + n + " + 2.0 * abs(" + n + "))") +
                          declare("back", n + " * (" + n + " - 2.0 * abs(" + n + "))") + code.statements;
        code.result = square_factor() + " * e";
        return code;
    }
    statements += "    // Interpolate irradiance at the axes by the squared cosines of those that n faces.\n" +
                  declare("shares", "squared_cosines(" + n + ")") +
                  "    float whole = shares.x + shares.y + shares.z;\n" +
                  declare("total", "light.c[0] + light.c[1] + light.c[2]") +
                  declare("own", "light.c[0] * shares.x + light.c[1] * shares.y + light.c[2] * shares.z") +
                  "    float factor = " + square_factor() + " / max(whole, " + literal(1e-6f) + ");\n";
    return {{squared_cosines()}, statements, "factor * (total * whole + 3.0 * own)"};
}

}  // namespace lobelia::cosine_lobes
