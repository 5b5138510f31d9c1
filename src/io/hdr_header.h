// The text header of a Radiance picture: format, exposure, primaries, size and orientation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/colour.h"
#include "lobelia/result.h"

namespace lobelia::io {

/// Orientation of scanlines. A scanline is a row, or a column if `columns`; x or y is reversed if the file stores it
/// from right to left or from the bottom up.
struct HdrOrientation {
    bool columns = false;
    bool x_reversed = false;
    bool y_reversed = false;
};

struct HdrHeader {
    enum class Encoding { rgbe, xyze };
    Encoding encoding = Encoding::rgbe;
    /// Factors in the pixels: all EXPOSURE and COLORCORR lines multiplied together.
    std::array<double, 3> multiplier{1, 1, 1};
    /// The white of PRIMARIES, or Radiance's own.
    Chromaticity white = k_equal_energy;
    /// True if PRIMARIES are given and are neither Rec. 709's nor Radiance's.
    bool foreign_primaries = false;
    HdrOrientation orientation;
    std::int64_t width = 0;
    std::int64_t height = 0;
    /// Byte at which the first scanline begins.
    std::size_t end = 0;
    std::vector<std::string> warnings;
};

/// Parses the header and the resolution line; sizes are numbers, but not yet checked against any limit.
[[nodiscard]] Result<HdrHeader> parse_hdr_header(std::span<const std::byte> bytes, std::string_view name);

}  // namespace lobelia::io
