// Shader code of cosine lobes.
#pragma once

#include <span>

#include "core/basis/cosine_lobes.h"
#include "lobelia/shader_code.h"

namespace lobelia::cosine_lobes {

/// Sum of coefficients times the squares of the cosines above 0; `direction` and `sum` are names.
[[nodiscard]] ShaderCode sum_of_squares(std::span<const Vec3> axes, const std::string& direction,
                                        const std::string& sum);

/// Sum of lobes about axes: three, or pairs of opposite ones, a multiple of six.
[[nodiscard]] ShaderCode radiance_code(CosineLobe lobe, std::span<const Vec3> axes);
/// Irradiance of whole lobes.
[[nodiscard]] ShaderCode exact_code(CosineLobe lobe, std::span<const Vec3> axes);
/// Irradiance at the axes, which are across or opposite to each other, interpolated by squared cosines; of max(0, c)^2.
[[nodiscard]] ShaderCode squares_code(std::span<const Vec3> axes);

}  // namespace lobelia::cosine_lobes
