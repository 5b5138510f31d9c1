#include "measure/prefilter_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bake/write/files_together.h"
#include "coefficients/encode.h"
#include "io/json.h"
#include "io/texture/container.h"
#include "lobelia/pixel_format.h"

namespace lobelia {
namespace {

constexpr std::size_t k_table_size = 64;

Result<PixelFormat> format_of(const std::string& name) {
    for (const PixelFormat format : pixel_formats())
        if (info(format).name == name) return format;
    return Error{"unknown pixel format \"" + name + "\""};
}

Status add_texture(FilesTogether& files, const std::string& name, const TextureFile& texture) {
    return files.add(
        name, [&](StagedFile& file) { return write_texture(*find_texture_container("ktx2").value(), file, texture); });
}

/// Bytes of a level in a pixel format, face after face.
std::vector<std::byte> packed(const CubeLevel& level, PixelFormat format, float scale) {
    std::vector<std::byte> bytes;
    const std::size_t texels = level.size * level.size;
    for (std::size_t face = 0; face < 6; ++face) {
        std::array<std::vector<float>, 4> planes;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t i = 0; i < texels; ++i)
                planes[k].push_back(k == 3 ? 1 : (&level.texels[face * texels + i].r)[k] / scale);
        std::vector<const float*> channels;
        for (std::size_t k = 0; k < info(format).channels; ++k) channels.push_back(planes[k].data());
        std::vector<std::byte> part(byte_size(format, level.size, level.size));
        encode_texels(format, level.size, level.size, channels, part);
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
}

Status add_cube(FilesTogether& files, const std::vector<CubeLevel>& levels, PixelFormat format, float scale,
                std::string_view convention) {
    std::vector<std::vector<std::byte>> bytes;
    for (const CubeLevel& level : levels) bytes.push_back(packed(level, format, scale));
    TextureFile texture{format, levels.front().size, levels.front().size};
    texture.levels.assign(bytes.begin(), bytes.end());
    texture.faces = 6;
    texture.metadata = {{"lobelia.channels", "radiance, prefiltered by GGX"},
                        {"lobelia.convention", std::string(convention)},
                        {"lobelia.scale", fmt::format("{}", scale)}};
    return add_texture(files, "specular.ktx2", texture);
}

Status add_table(FilesTogether& files) {
    const auto table = split_sum_table(k_table_size);
    std::array<std::vector<float>, 2> planes;
    for (const auto& entry : table)
        for (std::size_t k = 0; k < 2; ++k) planes[k].push_back(entry[k]);
    const std::array<const float*, 2> channels = {planes[0].data(), planes[1].data()};
    std::vector<std::byte> bytes(byte_size(PixelFormat::rg16f, k_table_size, k_table_size));
    encode_texels(PixelFormat::rg16f, k_table_size, k_table_size, channels, bytes);
    TextureFile texture{PixelFormat::rg16f, k_table_size, k_table_size, {bytes}};
    texture.metadata = {{"lobelia.channels", "scale of F0\nbias"}};
    return add_texture(files, "split-sum.ktx2", texture);
}

}  // namespace

Status write_prefilter(const std::filesystem::path& folder, const Image& radiance, const std::vector<CubeLevel>& levels,
                       const PrefilterFiles& about) {
    const auto format = format_of(about.format);
    if (!format) return format.error();
    auto files = FilesTogether::in(folder, about.options.stop);
    if (!files) return files.error();
    float largest = 0;
    for (const CubeLevel& level : levels)
        for (const Rgb& texel : level.texels) largest = std::max({largest, texel.r, texel.g, texel.b});
    const float scale = storing_scale(*format, largest);
    const std::string_view convention = k_cube_convention_names[static_cast<std::size_t>(about.options.convention)];
    if (Status status = add_cube(*files, levels, *format, scale, convention); !status) return status;
    if (Status status = add_table(*files); !status) return status;
    const auto harmonics = encode(radiance, default_codec());
    if (!harmonics) return harmonics.error();
    if (Status status = files->add_text("irradiance.json", to_text(*harmonics)); !status) return status;

    nlohmann::ordered_json described = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < levels.size(); ++i)
        described.push_back(
            {{"level", i}, {"size", levels[i].size}, {"roughness", levels[i].roughness}, {"error", levels[i].error}});
    const nlohmann::ordered_json document = {{"lobelia_prefilter", 1},
                                             {"source", about.source},
                                             {"at", about.at},
                                             {"convention", convention},
                                             {"specular", "specular.ktx2"},
                                             {"format", about.format},
                                             {"scale", scale},
                                             {"split_sum", "split-sum.ktx2"},
                                             {"irradiance", "irradiance.json"},
                                             {"samples", about.options.samples},
                                             {"levels", std::move(described)}};
    if (Status status = files->add_text("prefilter.json", json_text(document, 1) + "\n"); !status) return status;
    return files->commit();
}

}  // namespace lobelia
