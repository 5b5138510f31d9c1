// Rectangles into pages: the skyline packing of stb_rect_pack (Jylänki 2010), on as many pages as it takes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/stop.h"

namespace lobelia {

/// A rectangle and where it went.
struct PackedRectangle {
    int width = 0, height = 0;
    int x = 0, y = 0;
    std::uint32_t page = 0;
};

struct PackOptions {
    int width = 0, height = 0;  ///< of each page
    int padding = 0;            ///< least distance between rectangles
    StopFlag stop = {};         ///< asked for each page; Stopped is thrown
};

/// Places all rectangles on pages and returns the number of pages. Each rectangle fits a page (asserted). The same on
/// every platform.
std::size_t pack_rectangles(std::span<PackedRectangle> rectangles, const PackOptions& options);
/// Tells whether pack_rectangles takes one page, without packing a second one.
[[nodiscard]] bool fits_one_page(std::span<const PackedRectangle> rectangles, const PackOptions& options);

}  // namespace lobelia
