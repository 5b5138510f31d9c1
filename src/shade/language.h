// The languages that shader code is written in.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace lobelia::shade {

enum class Language { glsl, essl, hlsl, wgsl, msl };

struct LanguageInfo {
    Language language;
    std::string_view name;         ///< as options take it
    std::string_view description;  ///< such as "GLSL 4.50"
    std::string_view extension;    ///< of a file of its own, with the point
    std::string_view vec3;         ///< its name for three floats
};

/// THE list of languages. What differs between them in the text is in translate.cpp.
[[nodiscard]] std::span<const LanguageInfo> languages();
[[nodiscard]] const LanguageInfo& info(Language language);
[[nodiscard]] std::optional<Language> language_from_name(std::string_view name);

}  // namespace lobelia::shade
