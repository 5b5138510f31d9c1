// Shader code beside the textures of a bake.
#include "bake/write/shader_files.h"

#include <fmt/format.h>

#include "bake/write/ggx_table_file.h"
#include "lobelia/codec.h"
#include "shade/shader.h"

namespace lobelia {
namespace {

constexpr std::string_view k_stem = "decode.", k_table_stem = "ggx-lobe.";

}  // namespace

Status add_shaders(FilesTogether& files, const std::vector<const Storage*>& storages, const TextureContainer& container,
                   Manifest& manifest) {
    if (storages.empty()) return Done{};
    const auto codec = make_codec(manifest.options.codec);
    if (!codec) return codec.error();
    if (const auto code = codec->evaluator().irradiance_code(); !code) {
        manifest.warnings.push_back("no shader code is written: " + code.error().message);
        return Done{};
    }
    shade::ShaderRequest request;
    request.frame = manifest.options.frame == Frame::tangent ? shade::Frame::tangent : shade::Frame::scene;
    if (!codec->basis().specular_names().empty()) {
        request.needs.push_back(shade::Need::specular);
        const auto write = [&](StagedFile& file) { return write_ggx_table(container, file); };
        if (Status status = files.add(fmt::format("{}{}", k_table_stem, container.name), write); !status) return status;
    }
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
    for (const shade::LanguageInfo& language : shade::languages())
        if (name.starts_with(k_stem) && name.ends_with(language.extension)) return true;
    for (const TextureContainer& container : texture_containers())
        if (name.starts_with(k_table_stem) && name.substr(k_table_stem.size()) == container.name) return true;
    return false;
}

}  // namespace lobelia
