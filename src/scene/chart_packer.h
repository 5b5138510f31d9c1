// Packs rectangles into a square, on a grid: the lightmap charts of embedded scenes.
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
    std::uint32_t x = 0, y = 0;  ///< the corner nearest the origin
};

/// Returns places for all rectangles in a square of `side` units, at least `padding` units apart and half of that from
/// the border; nothing if they do not fit. High ones first, each as low as possible above those before (a skyline). The
/// same sizes give the same places.
[[nodiscard]] std::optional<std::vector<ChartPlace>> pack_charts(std::span<const ChartSize> sizes, std::uint32_t side,
                                                                 std::uint32_t padding);

}  // namespace lobelia
