#include "core/basis/direction_text.h"

#include "core/math/shader_text.h"

namespace lobelia::shader_text {

std::string dot_product(const std::string& direction, Vec3 axis) {
    if (axis.x != 0 && axis.y != 0 && axis.z != 0) return "dot(" + direction + ", " + literal(axis) + ")";
    std::string text;
    const auto add = [&](float factor, const char* component) {
        if (factor == 0) return;
        const bool first = text.empty();
        text += factor < 0 ? (first ? "-" : " - ") : (first ? "" : " + ");
        if (std::abs(factor) != 1) text += literal(std::abs(factor)) + " * ";
        text += direction + component;
    };
    add(axis.x, ".x");
    add(axis.y, ".y");
    add(axis.z, ".z");
    return text.empty() ? "0.0" : text;
}

std::string dot_products(const std::string& direction, const std::array<Vec3, 3>& axes) {
    if (axes == std::array{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) return direction;
    const std::array products = {dot_product(direction, axes[0]), dot_product(direction, axes[1]),
                                 dot_product(direction, axes[2])};
    const bool long_line = products[0].size() + products[1].size() + products[2].size() > 90;
    const std::string before = long_line ? "\n        " : "", between = long_line ? ",\n        " : ", ";
    return "vec3(" + before + products[0] + between + products[1] + between + products[2] + ")";
}

}  // namespace lobelia::shader_text
