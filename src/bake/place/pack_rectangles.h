// Rectangles into pages: the skyline packing of stb_rect_pack (Jylänki 2010), on as many pages as it takes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lobelia {

/// A rectangle and where it went.
struct PackedRectangle {
    int width = 0, height = 0;
    int x = 0, y = 0;
    std::uint32_t page = 0;
};

/// Places all rectangles on pages of width x height, at least `padding` apart, and returns the number of pages. Each
/// rectangle fits a page (asserted). The same on every platform.
std::size_t pack_rectangles(std::span<PackedRectangle> rectangles, int width, int height, int padding);

}  // namespace lobelia
