// Searches for the nearest usable texels by a list of offsets sorted by length.
#include "bake/finish/nearest.h"

#include <algorithm>
#include <tuple>

namespace lobelia {

NearestTexels::NearestTexels(const LightmapPage& page, std::size_t radius, float least_validity,
                             std::span<const std::uint8_t> excluded)
    : page_(page), excluded_(excluded), least_validity_(least_validity) {
    const int r = static_cast<int>(std::min(radius, std::max(page.width, page.height)));
    for (int y = -r; y <= r; ++y)
        for (int x = -r; x <= r; ++x)
            if (const int squared = x * x + y * y; squared > 0 && squared <= r * r) offsets_.push_back({x, y, squared});
    std::sort(offsets_.begin(), offsets_.end(), [](const Offset& a, const Offset& b) {
        return std::tie(a.squared, a.y, a.x) < std::tie(b.squared, b.y, b.x);
    });
}

void NearestTexels::find(std::size_t i, std::vector<std::uint32_t>& out) const {
    out.clear();
    if (usable(i)) {
        out.push_back(static_cast<std::uint32_t>(i));
        return;
    }
    if (page_.chart[i] != 0) find(i, Charts::own, out);
    if (out.empty()) find(i, Charts::any, out);
}

void NearestTexels::find(std::size_t i, Charts charts, std::vector<std::uint32_t>& out) const {
    const int width = static_cast<int>(page_.width), height = static_cast<int>(page_.height);
    const int x0 = static_cast<int>(i % page_.width), y0 = static_cast<int>(i / page_.width);
    int squared = 0;
    for (const Offset& offset : offsets_) {
        if (!out.empty() && offset.squared > squared) return;
        const int x = x0 + offset.x, y = y0 + offset.y;
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const std::size_t j = static_cast<std::size_t>(y) * page_.width + static_cast<std::size_t>(x);
        if (!usable(j) || (charts == Charts::own && page_.chart[j] != page_.chart[i])) continue;
        out.push_back(static_cast<std::uint32_t>(j));
        squared = offset.squared;
    }
}

}  // namespace lobelia
