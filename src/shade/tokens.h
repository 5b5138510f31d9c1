// Tokens of the shader source language (lobelia/shader_code.h). Together they are the whole text, blanks included.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobelia/result.h"

namespace lobelia::shade {

struct Token {
    enum class Kind { blank, comment, word, number, sign };
    Kind kind = Kind::blank;
    std::string text;

    [[nodiscard]] bool is(std::string_view other) const { return text == other; }
};

/// Splits a text. Errors: a character, a keyword, a type or a swizzle that is outside the language, with its line.
[[nodiscard]] Result<std::vector<Token>> tokens_of(std::string_view source);

}  // namespace lobelia::shade
