// Shader texts through glslangValidator, where it is installed (glslang-tools).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lobelia/result.h"
#include "shade/language.h"

namespace lobelia::test {

[[nodiscard]] bool has_glslang();

/// Compiles a whole compute shader. Errors: glslangValidator's messages. Languages: GLSL for Vulkan, HLSL with the
/// entry point main().
[[nodiscard]] Result<std::vector<std::uint32_t>> spirv_of(const std::string& text, shade::Language language);

/// Compiles a whole fragment shader and drops the result. Languages: GLSL for OpenGL, ESSL, HLSL.
[[nodiscard]] Status check_fragment_shader(const std::string& text, shade::Language language);

}  // namespace lobelia::test
