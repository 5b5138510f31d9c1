// DirectDraw Surface files with the header of Direct3D 10 (Microsoft, "Programming Guide for DDS").
#pragma once

#include "io/texture/container.h"

namespace lobelia {

/// Writes the texture; its format is stated as a DXGI_FORMAT. Formats without one are stated as the bytes that carry
/// them, R8G8B8A8_UNORM. There is no place for metadata.
[[nodiscard]] Status write_dds(StagedFile& file, const TextureFile& texture);

}  // namespace lobelia
