// 8-bit pictures for textures: PNG, JPEG and WebP. Safe on any bytes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// Red, green, blue, alpha as stored (no curve is undone), row by row from the top left.
struct PictureRgba8 {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;
};

/// Decodes a PNG, JPEG or WebP file of at most `most_pixels`; the content decides which. Grey becomes R = G = B,
/// missing alpha 255, 16 bits their upper 8, CMYK is converted without a colour profile; an orientation is ignored.
/// Errors begin with `name`, and name formats that are recognised but not read. Damaged and truncated files are errors.
[[nodiscard]] Result<PictureRgba8> read_picture_rgba8(std::span<const std::byte> bytes, std::string_view name,
                                                      std::size_t most_pixels);

}  // namespace lobelia
