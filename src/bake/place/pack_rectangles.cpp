// Packs rectangles by stb_rect_pack.
#include "bake/place/pack_rectangles.h"

#include <algorithm>
#include <cassert>

namespace {

/// Sorts with an order of equals that does not depend on the platform, unlike qsort's.
template <class T, class Compare>
void sort_stably(T* begin, int count, std::size_t, const Compare& compare) {
    std::stable_sort(begin, begin + count, [&](const T& a, const T& b) { return compare(&a, &b) < 0; });
}

}  // namespace

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#define STBRP_SORT sort_stably
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#endif
#include <stb/stb_rect_pack.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace lobelia {

std::size_t pack_rectangles(std::span<PackedRectangle> rectangles, int width, int height, int padding) {
    std::vector<stbrp_rect> left;
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        assert(rectangles[i].width <= width && rectangles[i].height <= height);
        left.push_back({static_cast<int>(i), rectangles[i].width + padding, rectangles[i].height + padding, 0, 0, 0});
    }

    // Fill one page after another; the padding after the last rectangle of a row may exceed the page.
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(width) + static_cast<std::size_t>(padding));
    std::uint32_t page = 0;
    for (; !left.empty(); ++page) {
        stbrp_context context;
        stbrp_init_target(&context, width + padding, height + padding, nodes.data(), static_cast<int>(nodes.size()));
        stbrp_pack_rects(&context, left.data(), static_cast<int>(left.size()));
        for (const stbrp_rect& placed : left)
            if (placed.was_packed) {
                PackedRectangle& rectangle = rectangles[static_cast<std::size_t>(placed.id)];
                rectangle.x = placed.x;
                rectangle.y = placed.y;
                rectangle.page = page;
            }
        std::erase_if(left, [](const stbrp_rect& r) { return r.was_packed != 0; });
    }
    return page;
}

}  // namespace lobelia
