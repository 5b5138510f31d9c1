// Shader code of ambient dice.
#pragma once

#include <array>
#include <span>

#include "lobelia/math.h"
#include "lobelia/shader_code.h"

namespace lobelia::dice {

/// patches: value and slopes are colours. linear: slopes are of luma, and chroma is linear between the vertices.
enum class Chroma { patches, linear };

[[nodiscard]] ShaderCode radiance_code(Chroma chroma, const Rotation& dice_from_domain);

/// Irradiance of functions at vertex 0, up to degree k_degree: harmonic coefficients. By symmetry they give the others.
inline constexpr std::size_t k_degree = 8;
struct VertexIrradiance {
    std::span<const float> value, first_slope, second_slope;
    std::span<const float> linear;                                     ///< of what is linear between the vertices
    std::array<Vec3, 2> (*tangents_at)(std::size_t vertex) = nullptr;  ///< the directions of the two slopes
};
[[nodiscard]] ShaderCode convolution_code(Chroma chroma, const VertexIrradiance& irradiance,
                                          const Rotation& dice_from_domain);

}  // namespace lobelia::dice
