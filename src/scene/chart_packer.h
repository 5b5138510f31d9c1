// Rectangles into a square, on a grid: where the charts of embedded scenes lie in their lightmap.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lobelia {

struct ChartSize {
    std::uint32_t width = 0, height = 0;
};
struct ChartPlace {
    std::uint32_t x = 0, y = 0;  ///< of the corner nearest the origin
};

/// Places for all of them in a square of `side` units, at least `padding` units apart and half of that from the border;
/// nothing where they do not fit. High ones first, each as low as it goes upon those before (a skyline). The same
/// sizes give the same places.
[[nodiscard]] std::optional<std::vector<ChartPlace>> pack_charts(std::span<const ChartSize> sizes, std::uint32_t side,
                                                                 std::uint32_t padding);

}  // namespace lobelia
