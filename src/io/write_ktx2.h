// Textures for GPUs as KTX 2.0 files (Khronos 2021): one 2D texture, one level, not supercompressed.
#pragma once

#include <map>
#include <span>
#include <string>

#include "io/staged_file.h"
#include "lobelia/pixel_format.h"

namespace lobelia {

struct Ktx2Texture {
    /// Stated by the VkFormat and the data format descriptor of the file. Formats without a VkFormat are stated as the
    /// bytes that carry them, R8G8B8A8_UNORM; the metadata should name them.
    PixelFormat format = PixelFormat::rgba16f;
    std::size_t width = 0, height = 0;  ///< texels, at least one each; (0, 0) is the top left
    std::span<const std::byte> data;    ///< byte_size(format, width, height) bytes
    /// Key-value texts; keys do not begin with "KTX". Orientation and writer are added.
    std::map<std::string, std::string> metadata;
};

/// Writes the texture as linear colours with Rec. 709 primaries. An error above 65536 texels a side.
[[nodiscard]] Status write_ktx2(StagedFile& file, const Ktx2Texture& texture);

}  // namespace lobelia
