// THE list of texture containers.
#include "io/texture/container.h"

#include <fmt/format.h>

#include <array>
#include <cassert>

#include "io/image_checks.h"
#include "io/texture/dds.h"
#include "io/texture/ktx2.h"

namespace lobelia {
namespace {

constexpr std::array k_containers = {
    TextureContainer{"ktx2", "KTX 2.0, not supercompressed, with metadata", write_ktx2},
    TextureContainer{"dds", "DirectDraw Surface with the header of Direct3D 10", write_dds},
};

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

Status write_texture(const TextureContainer& container, StagedFile& file, const TextureFile& texture) {
    constexpr auto k_most_side = static_cast<std::size_t>(io::k_most_side);
    if (texture.width == 0 || texture.height == 0 || texture.width > k_most_side || texture.height > k_most_side)
        return Error{fmt::format("a texture of {} x {} texels cannot be written", texture.width, texture.height)};
    assert(texture.data.size() == byte_size(texture.format, texture.width, texture.height));
    return container.write(file, texture);
}

}  // namespace lobelia
