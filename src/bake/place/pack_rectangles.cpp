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

namespace {

std::vector<stbrp_rect> padded(std::span<const PackedRectangle> rectangles, const PackOptions& options) {
    std::vector<stbrp_rect> result;
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        assert(rectangles[i].width <= options.width && rectangles[i].height <= options.height);
        result.push_back({static_cast<int>(i), rectangles[i].width + options.padding,
                          rectangles[i].height + options.padding, 0, 0, 0});
    }
    return result;
}

/// Packs as many as fit one page; the padding after the last rectangle of a row may exceed the page.
void fill_page(std::vector<stbrp_rect>& rectangles, const PackOptions& options) {
    options.stop.check();
    const int width = options.width + options.padding, height = options.height + options.padding;
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(width));
    stbrp_context context;
    stbrp_init_target(&context, width, height, nodes.data(), width);
    stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size()));
}

}  // namespace

bool fits_one_page(std::span<const PackedRectangle> rectangles, const PackOptions& options) {
    // Skip packing if the total area exceeds a page.
    double area = 0;
    for (const PackedRectangle& r : rectangles)
        area += static_cast<double>(r.width + options.padding) * (r.height + options.padding);
    if (area > static_cast<double>(options.width + options.padding) * (options.height + options.padding)) return false;
    std::vector<stbrp_rect> packed = padded(rectangles, options);
    fill_page(packed, options);
    return std::all_of(packed.begin(), packed.end(), [](const stbrp_rect& r) { return r.was_packed != 0; });
}

std::size_t pack_rectangles(std::span<PackedRectangle> rectangles, const PackOptions& options) {
    std::vector<stbrp_rect> left = padded(rectangles, options);
    std::uint32_t page = 0;
    for (; !left.empty(); ++page) {
        fill_page(left, options);
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
