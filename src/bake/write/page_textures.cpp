// Lightmap pages as textures for GPUs.
#include "bake/write/page_textures.h"

#include <fmt/format.h>

#include "core/storage/layout_text.h"
#include "lobelia/codec.h"

namespace lobelia {
namespace {

using Metadata = std::map<std::string, std::string>;

Metadata metadata_of(const TextureEntry& texture, const std::string& origin) {
    std::string channels;
    for (const StoredChannel& channel : texture.layout.channels)
        channels += (channels.empty() ? "" : "\n") + channel_text(channel);
    return {{"lobelia.storage", texture.storage},
            {"lobelia.format", std::string(info(texture.layout.format).name)},
            {"lobelia.channels", channels},
            {"lobelia.scale", fmt::format("{}", texture.scale)},
            {"lobelia.subsampling", fmt::format("{}", texture.layout.subsampling)},
            {"lobelia.origin", origin}};
}

TextureFile texture_file(const PackedTexture& packed, Metadata metadata) {
    return {packed.format, packed.width, packed.height, {packed.data}, std::move(metadata)};
}

/// Fractions in [0, 1] as 8 bits.
PackedTexture packed_validity(const LightmapPage& page) {
    PackedTexture packed{"validity", PixelFormat::r8, page.width, page.height, 1, {}};
    packed.data.resize(byte_size(packed.format, page.width, page.height));
    const float* channel = page.validity.data();
    encode_texels(packed.format, page.width, page.height, {&channel, 1}, packed.data);
    return packed;
}

}  // namespace

Result<PageTextures> PageTextures::make(const std::string& codec,
                                        const std::optional<std::vector<std::string>>& storages,
                                        std::string_view container) {
    PageTextures textures;
    const auto found_container = find_texture_container(container);
    if (!found_container) return found_container.error();
    textures.container_ = *found_container;
    if (codec.empty()) {
        if (storages && !storages->empty())
            return Error{"storage \"" + storages->front() + "\": plain irradiance has no coefficients to store"};
        return textures;
    }
    const auto made = make_codec(codec);
    if (!made) return made.error();
    textures.traits_ = coefficient_traits(*made->encoder());
    if (!storages) {
        textures.storages_ = default_storages(textures.traits_);
        return textures;
    }
    auto found = find_storages(*storages, textures.traits_);
    if (!found) return Error{codec + ": " + found.error().message};
    textures.storages_ = std::move(*found);
    return textures;
}

Status PageTextures::add(FilesTogether& files, const LightmapPage& page, const std::string& origin,
                         PageEntry& entry) const {
    if (storages_.empty()) return Done{};
    const std::string stem = std::filesystem::path(entry.file).stem().string();
    const CoefficientPlanes planes(page.width, page.height, std::span(page.planes), traits_.count);
    for (const Storage* storage : storages_) {
        const auto take = [&](const TextureLayout::Texture& layout, const PackedTexture& packed) {
            const std::string file = fmt::format("{}.{}.{}.{}", stem, storage->name, layout.name, container_->name);
            const TextureEntry& texture =
                entry.textures.emplace_back(TextureEntry{std::string(storage->name), file, layout, packed.scale});
            return files.add(file, [&](StagedFile& staged) {
                return write_texture(*container_, staged, texture_file(packed, metadata_of(texture, origin)));
            });
        };
        if (Status status = pack_each(storage->layout(traits_), planes, take, files.stop().flag()); !status)
            return status;
    }
    entry.validity = fmt::format("{}.validity.{}", stem, container_->name);
    return files.add(*entry.validity, [&](StagedFile& staged) {
        const PackedTexture packed = packed_validity(page);
        return write_texture(*container_, staged,
                             texture_file(packed, {{"lobelia.channels", "validity"}, {"lobelia.origin", origin}}));
    });
}

}  // namespace lobelia
