// KTX 2.0 files (Khronos 2021): one 2D texture, one level, not supercompressed.
#pragma once

#include "io/texture/container.h"

namespace lobelia {

/// Writes the texture; its format is stated by the VkFormat and the data format descriptor. Formats without a VkFormat
/// are stated as the bytes that carry them, R8G8B8A8_UNORM; the metadata should name them. Keys of the metadata do not
/// begin with "KTX"; orientation and writer are added.
[[nodiscard]] Status write_ktx2(StagedFile& file, const TextureFile& texture);

}  // namespace lobelia
