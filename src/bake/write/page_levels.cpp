// Halves pages, chart by chart.
#include "bake/write/page_levels.h"

#include <oneapi/tbb/parallel_for.h>

#include <array>

#include "bake/finish/finish.h"
#include "bake/finish/nearest.h"

namespace lobelia {
namespace {

/// The texels of a level that one of the next is made of.
struct Sources {
    std::array<std::size_t, 4> texel{};
    std::size_t count = 0;
    std::uint32_t chart = 0;  ///< plus 1; 0: none of them is valid, and all count
};

Sources sources_of(const LightmapPage& page, std::size_t x, std::size_t y, float least_validity) {
    const std::size_t first = 2 * y * page.width + 2 * x;
    const std::array<std::size_t, 4> four = {first, first + 1, first + page.width, first + page.width + 1};
    Sources best;
    for (const std::size_t i : four) {
        if (!is_usable(page, i, least_validity) || page.chart[i] == best.chart) continue;
        Sources of_chart;
        of_chart.chart = page.chart[i];
        for (const std::size_t j : four)
            if (page.chart[j] == of_chart.chart && is_usable(page, j, least_validity))
                of_chart.texel[of_chart.count++] = j;
        if (of_chart.count > best.count) best = of_chart;
    }
    if (best.count == 0) best = {four, 4, 0};
    return best;
}

LightmapPage halved(const LightmapPage& page, float least_validity, StopFlag stop) {
    LightmapPage half(page.width / 2, page.height / 2, page.planes.size());
    tbb::parallel_for(std::size_t{0}, half.height, [&](std::size_t y) {
        stop.check();
        for (std::size_t x = 0; x < half.width; ++x) {
            const Sources from = sources_of(page, x, y, least_validity);
            const std::size_t to = y * half.width + x;
            const float share = 1 / static_cast<float>(from.count);
            const auto mean = [&](const std::vector<float>& plane) {
                float sum = 0;
                for (std::size_t k = 0; k < from.count; ++k) sum += plane[from.texel[k]];
                return sum * share;
            };
            for (std::size_t c = 0; c < page.planes.size(); ++c) half.planes[c][to] = mean(page.planes[c]);
            half.chart[to] = from.chart;
            half.validity[to] = from.chart == 0 ? 0 : mean(page.validity);
        }
    });
    return half;
}

}  // namespace

std::vector<LightmapPage> mip_levels(const LightmapPage& page, std::size_t count, StopFlag stop) {
    DilateOptions options;
    options.stop = stop;
    std::vector<LightmapPage> levels;
    for (std::size_t i = 0; i < count; ++i) {
        levels.push_back(halved(levels.empty() ? page : levels.back(), options.least_validity, stop));
        dilate({&levels.back(), 1}, options);
    }
    return levels;
}

}  // namespace lobelia
