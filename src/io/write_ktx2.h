// Textures for GPUs as KTX 2.0 files (Khronos 2021): arrays of 2D layers, one level, not compressed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>

#include "io/staged_file.h"
#include "lobelia/texture_packing.h"

namespace lobelia {

struct Ktx2Texture {
    /// half: finite values beyond +-65504 are stored as that. unorm8: what is beyond [0, 1] is cut, NaN becomes 0.
    TexelFormat format = TexelFormat::half;
    std::size_t width = 0, height = 0, layers = 0;  ///< at least one each
    /// Texts for readers of the file, by keys that do not begin with "KTX". Orientation and writer are added.
    std::map<std::string, std::string> metadata;
};

/// Colours are linear with Rec. 709 primaries; (0, 0) is the top left.
using Rgba = std::array<float, 4>;

/// Writes the texture, asking for row after row: `fill(y, texels)` gives row y of all layers, width texels each. Some
/// rows are in memory at a time. An error for more than 65536 texels a side or 2048 layers, as GPUs have limits, too.
[[nodiscard]] Status write_ktx2(StagedFile& file, const Ktx2Texture& texture,
                                const std::function<void(std::size_t y, std::span<Rgba> texels)>& fill);

}  // namespace lobelia
