// Dot products of a direction with constants, as shader code.
#pragma once

#include <string>

#include "lobelia/math.h"

namespace lobelia::shader_text {

/// The code of direction . axis: "n.x", "0.8506508 * n.x - 0.5257311 * n.y", "dot(n, vec3(...))". Brackets it where it
/// is a sum only if the caller does.
[[nodiscard]] std::string dot_product(const std::string& direction, Vec3 axis);
/// The code of the vec3 of three such products, in lines of statements if it is long; `direction` itself where they are
/// its components.
[[nodiscard]] std::string dot_products(const std::string& direction, const std::array<Vec3, 3>& axes);

/// a times the matrix: the axis in the frame that the matrix turns from.
[[nodiscard]] constexpr Vec3 turned_back(const Rotation& m, Vec3 a) { return m[0] * a.x + m[1] * a.y + m[2] * a.z; }

}  // namespace lobelia::shader_text
