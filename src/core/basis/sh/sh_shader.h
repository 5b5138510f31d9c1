// Shader code of spherical harmonics: sums of bands as polynomials, and the models of degree 1.
#pragma once

#include <span>
#include <string>

#include "lobelia/shader_code.h"

namespace lobelia::sh_shader {

/// The sum of light.c[l^2 + l + m] factors[l] Y_lm at `direction` ("w" or "n"), as the variable `name`. Bands whose
/// factor is 0 are left out.
[[nodiscard]] ShaderCode sum_of_bands(std::span<const double> factors, const std::string& direction,
                                      const std::string& name);

/// Irradiance of degree 1 by the model of Geomerics, and with ZH3's guess of degree 2.
[[nodiscard]] ShaderCode geomerics();
[[nodiscard]] ShaderCode hallucinated();

/// Degree 1 and a zonal band 2, light.c[4], about the axis of the luminance or of each channel; `factors` of the bands.
enum class ZonalAxisCode { of_luminance, of_channel };
[[nodiscard]] ShaderCode zonal(std::span<const double> factors, ZonalAxisCode axis, const std::string& direction,
                               const std::string& name);

}  // namespace lobelia::sh_shader
