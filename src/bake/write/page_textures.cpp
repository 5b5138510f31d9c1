// Lightmap pages as textures for GPUs.
#include "bake/write/page_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "bake/write/page_levels.h"
#include "core/stop.h"
#include "core/storage/layout_text.h"
#include "lobelia/codec.h"

namespace lobelia {
namespace {

using Layout = TextureLayout::Texture;
using Metadata = std::map<std::string, std::string>;

/// The textures that share a file: one, or the layers of an array texture.
using Group = std::vector<std::size_t>;

/// The keys of a file; those that differ from layer to layer hold a text for each, an empty line between two.
Metadata metadata_of(const std::vector<TextureEntry>& entries, const Group& group, const std::string& origin) {
    const TextureEntry& first = entries[group.front()];
    Metadata keys = {{"lobelia.storage", first.storage},
                     {"lobelia.format", std::string(info(first.layout.format).name)},
                     {"lobelia.subsampling", fmt::format("{}", first.layout.subsampling)},
                     {"lobelia.origin", origin}};
    for (const std::size_t i : group) {
        const char* between = i == group.front() ? "" : "\n\n";
        keys["lobelia.channels"] += between + channels_text(entries[i].layout);
        keys["lobelia.scale"] += between + fmt::format("{}", entries[i].scale);
    }
    return keys;
}

/// Textures of one format and size, in the layout's order.
std::vector<Group> groups_of(const TextureLayout& layout, Switch arrays) {
    std::vector<Group> groups;
    for (std::size_t i = 0; i < layout.textures.size(); ++i) {
        const Layout& texture = layout.textures[i];
        const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
            const Layout& other = layout.textures[group.front()];
            return arrays == Switch::on && other.format == texture.format && other.subsampling == texture.subsampling;
        });
        if (same == groups.end())
            groups.push_back({i});
        else
            same->push_back(i);
    }
    return groups;
}

std::string file_name(const std::string& stem, const TextureLayout& layout, const Group& group) {
    const Layout& first = layout.textures[group.front()];
    if (group.size() == 1) return fmt::format("{}.{}", stem, first.name);
    return fmt::format("{}.{}{}", stem, info(first.format).name, first.subsampling > 1 ? "-half" : "");
}

/// Fractions in [0, 1] as 8 bits.
PackedTexture packed_validity(const LightmapPage& page) {
    PackedTexture packed{"validity", PixelFormat::r8, page.width, page.height, 1, {}};
    packed.data.resize(byte_size(packed.format, page.width, page.height));
    const float* channel = page.validity.data();
    encode_texels(packed.format, page.width, page.height, {&channel, 1}, packed.data);
    return packed;
}

/// Packs all textures of all levels: [level][texture].
Result<std::vector<std::vector<PackedTexture>>> packed_levels(const TextureLayout& layout,
                                                              std::span<const LightmapPage* const> levels,
                                                              StopFlag stop) {
    std::vector<std::vector<PackedTexture>> packed;
    std::vector<float> scales;
    for (const LightmapPage* page : levels) {
        auto& level = packed.emplace_back();
        const auto take = [&](const Layout&, const PackedTexture& texture) {
            level.push_back(texture);
            return Status(Done{});
        };
        const CoefficientPlanes planes(page->width, page->height, std::span(page->planes), layout.coefficients);
        if (Status status = pack_each(layout, planes, take, stop.flag(), scales); !status) return status.error();
        if (scales.empty())
            for (const PackedTexture& texture : level) scales.push_back(texture.scale);
    }
    return packed;
}

/// The texels of one level of a group, layer after layer.
std::vector<std::byte> joined(const std::vector<PackedTexture>& level, const Group& group) {
    std::vector<std::byte> bytes;
    for (const std::size_t i : group) bytes.insert(bytes.end(), level[i].data.begin(), level[i].data.end());
    return bytes;
}

/// An error if a page cannot be halved as often as the levels require, with the sub-sampling of a storage.
Status check_levels(std::uint32_t levels, std::array<std::size_t, 2> size, std::size_t subsampling) {
    const std::size_t divisor = (std::size_t{1} << (levels - 1)) * (levels > 1 ? subsampling : 1);
    if (size[0] % divisor == 0 && size[1] % divisor == 0) return Done{};
    return Error{fmt::format("{} mip levels: the sides of a page of {} x {} texels are not multiples of {}", levels,
                             size[0], size[1], divisor)};
}

}  // namespace

Result<PageTextures> PageTextures::make(const std::string& codec, const TextureOptions& options,
                                        std::array<std::size_t, 2> page_size) {
    PageTextures textures;
    textures.options_ = options;
    const auto found_container = find_texture_container(options.container);
    if (!found_container) return found_container.error();
    textures.container_ = *found_container;
    if (options.zstd == Switch::on && !textures.container_->compresses)
        return Error{fmt::format("zstd: the texture container \"{}\" has no compression", options.container)};
    if (codec.empty()) {
        if (options.storages && !options.storages->empty())
            return Error{"storage \"" + options.storages->front() +
                         "\": plain irradiance has no coefficients to store"};
        return textures;
    }
    const auto made = make_codec(codec);
    if (!made) return made.error();
    textures.traits_ = coefficient_traits(*made->encoder());
    if (!options.storages) {
        textures.storages_ = default_storages(textures.traits_);
    } else {
        auto found = find_storages(*options.storages, textures.traits_);
        if (!found) return Error{codec + ": " + found.error().message};
        textures.storages_ = std::move(*found);
    }
    for (const Storage* storage : textures.storages_)
        for (const Layout& texture : storage->layout(textures.traits_).textures)
            if (Status status = check_levels(options.levels, page_size, texture.subsampling); !status)
                return status.error();
    return textures;
}

TextureFile PageTextures::texture_file(const PackedTexture& largest, std::size_t layers) const {
    TextureFile file{largest.format, largest.width, largest.height};
    file.layers = layers;
    file.compressed = options_.zstd == Switch::on;
    return file;
}

Status PageTextures::add_storage(FilesTogether& files, std::span<const LightmapPage* const> levels,
                                 const Storage& storage, const std::string& origin, PageEntry& entry) const {
    const TextureLayout layout = storage.layout(traits_);
    const auto packed = packed_levels(layout, levels, files.stop());
    if (!packed) return packed.error();
    std::vector<TextureEntry> entries;
    for (std::size_t i = 0; i < layout.textures.size(); ++i)
        entries.push_back({std::string(storage.name), {}, layout.textures[i], packed->front()[i].scale});
    const std::string stem =
        fmt::format("{}.{}", std::filesystem::path(entry.file).stem().string(), std::string(storage.name));
    for (const Group& group : groups_of(layout, options_.arrays)) {
        const bool is_array = group.size() > 1;
        const std::string name = fmt::format("{}.{}", file_name(stem, layout, group), container_->name);
        for (std::size_t layer = 0; layer < group.size(); ++layer) {
            entries[group[layer]].file = name;
            if (is_array) entries[group[layer]].layer = layer;
        }
        std::vector<std::vector<std::byte>> bytes;
        for (const auto& level : *packed) bytes.push_back(joined(level, group));
        TextureFile texture = texture_file(packed->front()[group.front()], is_array ? group.size() : 0);
        texture.levels.assign(bytes.begin(), bytes.end());
        texture.metadata = metadata_of(entries, group, origin);
        const auto write = [&](StagedFile& staged) { return write_texture(*container_, staged, texture); };
        if (Status status = files.add(name, write); !status) return status;
    }
    std::move(entries.begin(), entries.end(), std::back_inserter(entry.textures));
    return Done{};
}

Status PageTextures::add(FilesTogether& files, const LightmapPage& page, const std::string& origin,
                         PageEntry& entry) const {
    if (storages_.empty()) return Done{};
    return unless_stopped([&]() -> Status {
        const std::vector<LightmapPage> smaller = mip_levels(page, options_.levels - 1, files.stop());
        std::vector<const LightmapPage*> levels = {&page};
        for (const LightmapPage& level : smaller) levels.push_back(&level);
        for (const Storage* storage : storages_)
            if (Status status = add_storage(files, levels, *storage, origin, entry); !status) return status;

        entry.validity =
            fmt::format("{}.validity.{}", std::filesystem::path(entry.file).stem().string(), container_->name);
        std::vector<PackedTexture> packed;
        for (const LightmapPage* level : levels) packed.push_back(packed_validity(*level));
        TextureFile texture = texture_file(packed.front(), 0);
        for (const PackedTexture& level : packed) texture.levels.emplace_back(level.data);
        texture.metadata = {{"lobelia.channels", "validity"}, {"lobelia.origin", origin}};
        return files.add(*entry.validity,
                         [&](StagedFile& staged) { return write_texture(*container_, staged, texture); });
    });
}

}  // namespace lobelia
