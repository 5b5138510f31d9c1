// Texture containers: the file formats in which textures for GPUs are written.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "io/staged_file.h"
#include "lobelia/pixel_format.h"

namespace lobelia {

/// A 2D texture of one level, in linear colours with Rec. 709 primaries.
struct TextureFile {
    PixelFormat format = PixelFormat::rgba16f;
    std::size_t width = 0, height = 0;  ///< texels, at least one each; (0, 0) is the top left
    std::span<const std::byte> data;    ///< byte_size(format, width, height) bytes
    /// Key-value texts, for containers that have a place for them.
    std::map<std::string, std::string> metadata;
};

struct TextureContainer {
    std::string_view name;  ///< also the extension of its files
    std::string_view description;
    /// Writes the texture, whose size is valid. It holds every pixel format: formats that it has no number for are
    /// stored as the bytes that carry them, four channels of 8 bits.
    Status (*write)(StagedFile& file, const TextureFile& texture);
};

/// THE list (src/io/texture/container.cpp).
[[nodiscard]] std::span<const TextureContainer> texture_containers();

/// Returns a container by name; the error lists the names.
[[nodiscard]] Result<const TextureContainer*> find_texture_container(std::string_view name);

/// Writes a texture. An error above 65536 texels a side.
[[nodiscard]] Status write_texture(const TextureContainer& container, StagedFile& file, const TextureFile& texture);

}  // namespace lobelia
