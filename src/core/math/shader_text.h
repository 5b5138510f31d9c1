// Numbers and sums as shader code.
#pragma once

#include <span>
#include <string>

#include "lobelia/planes.h"
#include "lobelia/shader_code.h"

namespace lobelia::shader_text {

/// A float as the shortest literal that reads back as the same float: "0.28209478", "1.0", "-3.0e-7".
[[nodiscard]] std::string literal(float value);
[[nodiscard]] inline std::string literal(double value) { return literal(static_cast<float>(value)); }
/// "vec3(0.0, 0.0, 1.0)".
[[nodiscard]] std::string literal(Vec3 v);
/// "vec3(...)" of three doubles.
[[nodiscard]] std::string literal(double x, double y, double z);
/// "light.c[3]".
[[nodiscard]] std::string coefficient(std::size_t i);

/// sum_of({"0.5", "n.y"}) is the code of light.c[0] * 0.5 + light.c[1] * n.y: one term a line, by additions to `name`.
/// The result of the code is `name`.
[[nodiscard]] ShaderCode sum_of(std::span<const std::string> weights, const std::string& name);

}  // namespace lobelia::shader_text
