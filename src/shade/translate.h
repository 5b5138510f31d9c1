// Translation of the shader source language (lobelia/shader_code.h), token by token: layout, names and comments stay.
#pragma once

#include <string>
#include <string_view>

#include "lobelia/result.h"
#include "shade/language.h"

namespace lobelia::shade {

/// Translates structs, constants and functions. `source` may also hold, at its outermost level, structs
/// "struct Name {\n    vec4 member;\n    vec3 member[9];\n};\n" and constants "const float k_name = 1.0;\n". Errors:
/// text outside the language, with its line.
[[nodiscard]] Result<std::string> translate(std::string_view source, Language language);

}  // namespace lobelia::shade
