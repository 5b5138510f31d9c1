// Packs rectangles into pages by the skyline method of stb_rect_pack (Jylänki 2010), on as many pages as needed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/stop.h"

namespace lobelia {

/// A rectangle and its place.
struct PackedRectangle {
    int width = 0, height = 0;
    int x = 0, y = 0;
    std::uint32_t page = 0;
};

struct PackOptions {
    int width = 0, height = 0;  ///< of each page
    int padding = 0;            ///< minimum distance between rectangles
    StopFlag stop = {};         ///< checked for each page; Stopped is thrown
};

/// Places all rectangles on pages, and returns the number of pages. Gives the same result on every platform.
/// Precondition: each rectangle fits a page (asserted).
std::size_t pack_rectangles(std::span<PackedRectangle> rectangles, const PackOptions& options);
/// Returns whether pack_rectangles needs one page only, without packing a second one.
[[nodiscard]] bool fits_one_page(std::span<const PackedRectangle> rectangles, const PackOptions& options);

}  // namespace lobelia
