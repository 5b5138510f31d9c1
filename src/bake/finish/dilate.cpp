// Dilation: fills texels that were not baked from their nearest baked neighbours.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "bake/finish/finish.h"
#include "bake/finish/nearest.h"

namespace lobelia {
namespace {

/// The filled texels of some rows and their sources: target[i] is the mean of sources [first[i], first[i + 1]).
struct Fillings {
    std::vector<std::uint32_t> target, first{0}, sources;
};

/// Rows per task.
constexpr std::size_t k_rows = 32;

/// Marks texels with a usable texel within `radius` in x and in y; the others need no search.
std::vector<std::uint8_t> near_usable(const LightmapPage& page, const DilateOptions& options) {
    const std::size_t w = page.width, h = page.height;
    std::vector<std::uint8_t> along_rows(page.size()), result(page.size());
    // Mark a texel if the last usable one before it, or the next one after it, is within the radius.
    const auto spread = [&](std::size_t count, const auto& usable, const auto& mark) {
        std::size_t since = options.radius + 1;
        for (std::size_t i = 0; i < count; ++i) {
            since = usable(i) ? 0 : std::min(since + 1, options.radius + 1);
            if (since <= options.radius) mark(i);
        }
        since = options.radius + 1;
        for (std::size_t i = count; i-- > 0;) {
            since = usable(i) ? 0 : std::min(since + 1, options.radius + 1);
            if (since <= options.radius) mark(i);
        }
    };
    tbb::parallel_for(std::size_t{0}, h, [&](std::size_t y) {
        spread(
            w, [&](std::size_t x) { return is_usable(page, y * w + x, options.least_validity); },
            [&](std::size_t x) { along_rows[y * w + x] = 1; });
    });
    tbb::parallel_for(std::size_t{0}, w, [&](std::size_t x) {
        spread(
            h, [&](std::size_t y) { return along_rows[y * w + x] != 0; },
            [&](std::size_t y) { result[y * w + x] = 1; });
    });
    return result;
}

std::vector<Fillings> find_fillings(const LightmapPage& page, const DilateOptions& options) {
    const NearestTexels nearest(page, options.radius, options.least_validity);
    const std::vector<std::uint8_t> worth_it = near_usable(page, options);
    std::vector<Fillings> result((page.height + k_rows - 1) / k_rows);
    tbb::parallel_for(std::size_t{0}, result.size(), [&](std::size_t block) {
        options.stop.check();
        Fillings& fillings = result[block];
        std::vector<std::uint32_t> sources;
        const std::size_t end = std::min((block + 1) * k_rows, page.height) * page.width;
        for (std::size_t i = block * k_rows * page.width; i < end; ++i) {
            if (worth_it[i] == 0 || is_usable(page, i, options.least_validity)) continue;
            nearest.find(i, sources);
            if (sources.empty()) continue;
            fillings.target.push_back(static_cast<std::uint32_t>(i));
            fillings.sources.insert(fillings.sources.end(), sources.begin(), sources.end());
            fillings.first.push_back(static_cast<std::uint32_t>(fillings.sources.size()));
        }
    });
    return result;
}

/// Fills the targets of a plane. Sources are never targets, so the order does not matter.
void fill(const Fillings& fillings, std::vector<float>& plane) {
    for (std::size_t i = 0; i < fillings.target.size(); ++i) {
        float sum = 0;
        for (std::uint32_t k = fillings.first[i]; k < fillings.first[i + 1]; ++k) sum += plane[fillings.sources[k]];
        plane[fillings.target[i]] = sum / static_cast<float>(fillings.first[i + 1] - fillings.first[i]);
    }
}

}  // namespace

void dilate(std::span<LightmapPage> pages, const DilateOptions& options) {
    for (LightmapPage& page : pages) {
        const std::vector<Fillings> fillings = find_fillings(page, options);
        tbb::parallel_for(std::size_t{0}, page.planes.size(), [&](std::size_t c) {
            options.stop.check();
            tbb::parallel_for(std::size_t{0}, fillings.size(),
                              [&](std::size_t b) { fill(fillings[b], page.planes[c]); });
        });
    }
}

}  // namespace lobelia
