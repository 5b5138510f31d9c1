// THE list of texture containers.
#include "io/texture/container.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "io/image_checks.h"
#include "io/texture/dds.h"
#include "io/texture/ktx2.h"

namespace lobelia {
namespace {

constexpr std::array k_containers = {
    TextureContainer{"ktx2", "KTX 2.0, with metadata; zstd on request", true, write_ktx2},
    TextureContainer{"dds", "DirectDraw Surface with the header of Direct3D 10", false, write_dds},
};

#ifndef NDEBUG
std::size_t most_levels(const TextureFile& texture) {
    return static_cast<std::size_t>(std::bit_width(std::max({texture.width, texture.height, texture.depth})));
}
#endif

}  // namespace

std::span<const TextureContainer> texture_containers() { return k_containers; }

Result<const TextureContainer*> find_texture_container(std::string_view name) {
    std::string names;
    for (const TextureContainer& container : k_containers) {
        if (container.name == name) return &container;
        names += (names.empty() ? "" : ", ") + std::string(container.name);
    }
    return Error{fmt::format("unknown texture container \"{}\"; available: {}", name, names)};
}

std::size_t image_bytes(const TextureFile& texture, std::size_t level) {
    return byte_size(texture.format, level_size(texture.width, level), level_size(texture.height, level)) *
           std::max<std::size_t>(level_size(texture.depth, level), 1);
}

Status write_texture(const TextureContainer& container, StagedFile& file, const TextureFile& texture) {
    constexpr auto k_most_side = static_cast<std::size_t>(io::k_most_side);
    const auto is_side = [&](std::size_t size) { return size > 0 && size <= k_most_side; };
    if (!is_side(texture.width) || !is_side(texture.height) || texture.depth > k_most_side ||
        texture.layers > k_most_side)
        return Error{fmt::format("a texture of {} x {} texels, {} slices and {} layers cannot be written",
                                 texture.width, texture.height, texture.depth, texture.layers)};
    if (texture.compressed && !container.compresses)
        return Error{fmt::format("the texture container \"{}\" has no compression", container.name)};
    assert(texture.faces == 1 || (texture.faces == 6 && texture.width == texture.height && texture.depth == 0));
    assert(texture.depth == 0 || texture.layers == 0);
    assert(!texture.levels.empty() && texture.levels.size() <= most_levels(texture));
    for (std::size_t level = 0; level < texture.levels.size(); ++level)
        assert(texture.levels[level].size() == texture.images() * image_bytes(texture, level));
    return container.write(file, texture);
}

}  // namespace lobelia
