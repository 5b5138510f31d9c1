// Texture containers: the file formats in which textures for GPUs are written.
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/staged_file.h"
#include "lobelia/pixel_format.h"

namespace lobelia {

/// A texture with its mip levels, in linear colours with Rec. 709 primaries.
struct TextureFile {
    PixelFormat format = PixelFormat::rgba16f;
    std::size_t width = 0, height = 0;  ///< texels of the largest level; (0, 0) is the top left
    /// The largest level first, each half as wide, high and deep as the one before, rounded down, but at least 1. A
    /// level holds layer after layer, of each face after face (+x, -x, +y, -y, +z, -z), of each slice after slice.
    std::vector<std::span<const std::byte>> levels = {};
    /// Key-value texts, for containers that have a place for them.
    std::map<std::string, std::string> metadata = {};
    std::size_t layers = 0;   ///< of an array texture; 0: it is none
    std::size_t faces = 1;    ///< 6: a cube map, whose faces are squares
    std::size_t depth = 0;    ///< slices of a 3D texture; 0: it is 2D
    bool compressed = false;  ///< by zstd, where the container can

    /// The images of each level: layers times faces.
    [[nodiscard]] std::size_t images() const { return std::max<std::size_t>(layers, 1) * faces; }
};

/// Returns one dimension of a mip level; 0 stays 0.
[[nodiscard]] constexpr std::size_t level_size(std::size_t size, std::size_t level) {
    return size == 0 ? 0 : std::max<std::size_t>(size >> level, 1);
}
/// Returns the bytes that one image takes in a level, all its slices.
[[nodiscard]] std::size_t image_bytes(const TextureFile& texture, std::size_t level);

struct TextureContainer {
    std::string_view name;  ///< also the extension of its files
    std::string_view description;
    bool compresses = false;  ///< obeys TextureFile::compressed
    /// Writes the texture, whose sizes are valid. It holds every pixel format: formats that it has no number for are
    /// stored as the bytes that carry them, four channels of 8 bits.
    Status (*write)(StagedFile& file, const TextureFile& texture);
};

/// THE list (src/io/texture/container.cpp).
[[nodiscard]] std::span<const TextureContainer> texture_containers();

/// Returns a container by name; the error lists the names.
[[nodiscard]] Result<const TextureContainer*> find_texture_container(std::string_view name);

/// Writes a texture. An error above 65536 texels a side, and for `compressed` where the container has no such thing.
[[nodiscard]] Status write_texture(const TextureContainer& container, StagedFile& file, const TextureFile& texture);

}  // namespace lobelia
