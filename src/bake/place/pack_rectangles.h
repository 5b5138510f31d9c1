// Packs rectangles into pages by the skyline method of stb_rect_pack (Jylänki 2010), on as many pages as needed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lobelia {

/// A rectangle and its place.
struct PackedRectangle {
    int width = 0, height = 0;
    int x = 0, y = 0;
    std::uint32_t page = 0;
};

/// Places all rectangles on pages of width x height, at least `padding` apart, and returns the number of pages. Gives
/// the same result on every platform. Precondition: each rectangle fits a page (asserted).
std::size_t pack_rectangles(std::span<PackedRectangle> rectangles, int width, int height, int padding);

}  // namespace lobelia
