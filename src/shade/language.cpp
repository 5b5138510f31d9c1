#include "shade/language.h"

#include <array>

namespace lobelia::shade {
namespace {

constexpr std::array k_languages = {
    LanguageInfo{Language::glsl, "glsl", "GLSL 4.50", ".glsl", "vec3"},
    LanguageInfo{Language::essl, "essl", "GLSL ES 3.00", ".essl", "vec3"},
    LanguageInfo{Language::hlsl, "hlsl", "HLSL, shader model 5", ".hlsl", "float3"},
    LanguageInfo{Language::wgsl, "wgsl", "WGSL", ".wgsl", "vec3f"},
    LanguageInfo{Language::msl, "msl", "Metal Shading Language 2", ".metal", "float3"},
};

}  // namespace

std::span<const LanguageInfo> languages() { return k_languages; }

const LanguageInfo& info(Language language) { return k_languages[static_cast<std::size_t>(language)]; }

std::optional<Language> language_from_name(std::string_view name) {
    for (const auto& entry : k_languages)
        if (entry.name == name) return entry.language;
    return std::nullopt;
}

}  // namespace lobelia::shade
