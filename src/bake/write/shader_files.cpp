// Shader code beside the textures of a bake.
#include "bake/write/shader_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/codec.h"
#include "shade/shader.h"

namespace lobelia {
namespace {

constexpr std::string_view k_stem = "decode.";

}  // namespace

Status add_shaders(FilesTogether& files, const std::vector<const Storage*>& storages, Manifest& manifest) {
    if (storages.empty()) return Done{};
    const auto codec = make_codec(manifest.options.codec);
    if (!codec) return codec.error();
    if (const auto code = codec->evaluator().irradiance_code(); !code) {
        manifest.warnings.push_back("no shader code is written: " + code.error().message);
        return Done{};
    }
    shade::ShaderRequest request;
    request.frame = manifest.options.frame == Frame::tangent ? shade::Frame::tangent : shade::Frame::scene;
    for (const Storage* storage : storages) {
        request.storage = storage;
        for (const shade::LanguageInfo& language : shade::languages()) {
            // The code is the same in both kinds of GLSL.
            if (language.language == shade::Language::essl) continue;
            request.language = language.language;
            const auto text = shade::shader_text(*codec, request);
            if (!text) return text.error();
            const std::string name = fmt::format("{}{}{}", k_stem, storage->name, language.extension);
            if (Status status = files.add_text(name, *text); !status) return status;
        }
    }
    return Done{};
}

bool is_name_of_shader(std::string_view name) {
    const auto& list = shade::languages();
    return name.starts_with(k_stem) && std::any_of(list.begin(), list.end(), [&](const shade::LanguageInfo& language) {
               return name.ends_with(language.extension);
           });
}

}  // namespace lobelia
