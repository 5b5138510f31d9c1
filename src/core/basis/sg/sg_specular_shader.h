// Shader code of glossy reflection of spherical Gaussians.
#pragma once

#include <span>

#include "core/basis/sg/sg_specular_lanes.h"
#include "lobelia/shader_code.h"

namespace lobelia::sg_shader {

/// The sum of coefficients times the reflected light of the lobes, which are ambient below k_ambient_sharpness.
[[nodiscard]] ShaderCode reflected(SgSpecular kind, std::span<const SgLight> lights);

/// The same for `count` lobes that the coefficients hold, light.c[2 i] the amplitude and light.c[2 i + 1] the axis
/// times the sharpness.
[[nodiscard]] ShaderCode fitted_reflected(SgSpecular kind, std::size_t count);

}  // namespace lobelia::sg_shader
