// Shader code from a pattern.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace lobelia::shader_text {

/// Replaces $0 to $9 by the values.
[[nodiscard]] inline std::string filled(std::string_view pattern, std::initializer_list<std::string> values) {
    std::string text;
    for (std::size_t i = 0; i < pattern.size(); ++i)
        if (pattern[i] == '$')
            text += values.begin()[pattern[++i] - '0'];
        else
            text += pattern[i];
    return text;
}

}  // namespace lobelia::shader_text
