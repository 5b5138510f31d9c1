// Rectangles into a square, on a grid.
#include "scene/chart_packer.h"

#include <algorithm>
#include <numeric>

namespace lobelia {
namespace {

/// The height that has been built up over each column of the square.
class Skyline {
  public:
    explicit Skyline(std::uint32_t side) : heights_(side) {}

    /// The lowest place for a rectangle that small, the leftmost of equals; nothing where it would stick out.
    [[nodiscard]] std::optional<ChartPlace> lowest(ChartSize size) const {
        const auto side = static_cast<std::uint32_t>(heights_.size());
        std::optional<ChartPlace> best;
        for (std::uint32_t x = 0; x + size.width <= side; ++x) {
            // It can only lie better further left unless a step begins here.
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

    // Lay each down with its padding around it.
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
