// Luma and chroma to colours, as shader code.
#pragma once

#include "lobelia/shader_code.h"

namespace lobelia::shader_text {

/// vec3 rgb_from_ycocg(float luma, float orange, float green), as Component of lobelia/texture_layout.h defines them.
[[nodiscard]] inline ShaderFunction rgb_from_ycocg() {
    return {
        "rgb_from_ycocg",
        "/// Returns the colour of luma and chroma: Y = (r + 2 g + b) / 4, Co = (r - b) / 2, Cg = (2 g - r - b) / 4.\n"
        "vec3 rgb_from_ycocg(float luma, float orange, float green) {\n"
        "    return vec3(luma + orange - green, luma + green, luma - orange - green);\n"
        "}\n"};
}

}  // namespace lobelia::shader_text
