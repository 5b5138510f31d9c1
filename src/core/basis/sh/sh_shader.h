// Shader code of spherical harmonics: sums of bands as polynomials, and the models of degree 1.
#pragma once

#include <span>
#include <string>

#include "lobelia/shader_code.h"

namespace lobelia::sh_shader {

/// Radiance of the harmonics of degrees 0 to `degree`, light.c[l^2 + l + m] for Y_lm.
[[nodiscard]] ShaderCode radiance(std::size_t degree);
/// Irradiance, each band times its entry of `factors`; bands whose factor is 0 are left out. `window` is the name of
/// the window that the factors contain, empty for none.
[[nodiscard]] ShaderCode irradiance(std::span<const double> factors, const std::string& window);

/// Reflected light of the harmonics of degrees 0 to `degree`: each band times its mean Legendre polynomial, in the mean
/// direction of the reflection, or for a view along the normal, in the mirror direction.
[[nodiscard]] ShaderCode convolved(std::size_t degree);
[[nodiscard]] ShaderCode prefiltered(std::size_t degree);
/// Reflected light of degree 1 as ambient light and a lamp.
[[nodiscard]] ShaderCode dominant();

/// Irradiance of degree 1 by the model of Geomerics, and with ZH3's guess of degree 2.
[[nodiscard]] ShaderCode geomerics();
[[nodiscard]] ShaderCode hallucinated();

/// Degree 1 and a zonal band 2, light.c[4], about the axis of the luminance or of each channel; `factors` of the bands.
enum class ZonalAxisCode { of_luminance, of_channel };
[[nodiscard]] ShaderCode zonal(std::span<const double> factors, ZonalAxisCode axis, const std::string& direction);

}  // namespace lobelia::sh_shader
