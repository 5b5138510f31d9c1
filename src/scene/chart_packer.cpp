// Packs rectangles into a square, on a grid.
#include "scene/chart_packer.h"

#include <algorithm>
#include <numeric>

namespace lobelia {
namespace {

/// The occupied height of each column of the square.
class Skyline {
  public:
    explicit Skyline(std::uint32_t side) : heights_(side) {}

    /// Returns the lowest place for a rectangle of this size, the leftmost of equals; nothing if it does not fit.
    [[nodiscard]] std::optional<ChartPlace> lowest(ChartSize size) const {
        const auto side = static_cast<std::uint32_t>(heights_.size());
        std::optional<ChartPlace> best;
        for (std::uint32_t x = 0; x + size.width <= side; ++x) {
            // Skip columns without a step: the place to their left is as low.
            if (x > 0 && heights_[x] == heights_[x - 1]) continue;
            const std::uint32_t y = *std::max_element(heights_.begin() + x, heights_.begin() + x + size.width);
            if (y + size.height <= side && (!best || y < best->y)) best = ChartPlace{x, y};
        }
        return best;
    }

    void cover(ChartPlace place, ChartSize size) {
        std::fill_n(heights_.begin() + place.x, size.width, place.y + size.height);
    }

  private:
    std::vector<std::uint32_t> heights_;
};

}  // namespace

std::optional<std::vector<ChartPlace>> pack_charts(std::span<const ChartSize> sizes, std::uint32_t side,
                                                   std::uint32_t padding) {
    // Sort by height, then by width.
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return sizes[a].height != sizes[b].height ? sizes[a].height > sizes[b].height : sizes[a].width > sizes[b].width;
    });

    // Place each rectangle with its padding.
    Skyline skyline(side);
    std::vector<ChartPlace> places(sizes.size());
    for (const std::size_t i : order) {
        const ChartSize padded{sizes[i].width + padding, sizes[i].height + padding};
        const auto place = skyline.lowest(padded);
        if (!place) return std::nullopt;
        skyline.cover(*place, padded);
        places[i] = {place->x + padding / 2, place->y + padding / 2};
    }
    return places;
}

}  // namespace lobelia
