// Shader code of spherical Gaussians: radiance, and irradiance by each formula.
#pragma once

#include <span>
#include <vector>

#include "core/basis/sg/sg_irradiance.h"
#include "lobelia/shader_code.h"

namespace lobelia::sg_shader {

/// The sum of coefficients times lobes at the direction w.
[[nodiscard]] ShaderCode radiance(std::span<const Lobe> lobes);

/// The sum of coefficients times the irradiances of lobes at the normal n; `constants` are those of each lobe, in the
/// order of the kind's formula, none for ambient ones.
[[nodiscard]] ShaderCode irradiance(SgIrradiance kind, std::span<const Lobe> lobes,
                                    const std::vector<std::vector<float>>& constants);

/// The same for `count` lobes that the coefficients hold, light.c[2 i] the amplitude and light.c[2 i + 1] the axis
/// times the sharpness. Errors: a kind whose constants cannot be computed in a shader.
[[nodiscard]] ShaderCode fitted_radiance(std::size_t count);
[[nodiscard]] Result<ShaderCode> fitted_irradiance(SgIrradiance kind, std::size_t count);

}  // namespace lobelia::sg_shader
