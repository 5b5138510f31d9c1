// Converts coefficients that are linear in the light to those of a fitted basis.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cassert>

#include "bake/finish/finish.h"

namespace lobelia {
namespace {

LightmapPage fitted_page(const LightmapPage& from, const FittedBasis& basis, StopFlag stop) {
    const PageChannels source{basis.accumulated()->size()}, target{basis.size()};
    assert(from.planes.size() == source.count());
    LightmapPage to(from.width, from.height, target.count());
    to.chart = from.chart;
    to.validity = from.validity;
    // Copy the channels that are not coefficients.
    for (std::size_t k = 0; k < 4; ++k) to.planes[target.irradiance(0) + k] = from.planes[source.irradiance(0) + k];
    constexpr std::size_t k_grain = 256;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), k_grain), [&](const auto& range) {
        std::vector<Rgb> accumulated(source.coefficients), c(target.coefficients);
        for (std::size_t pixel = range.begin(); pixel < range.end(); ++pixel) {
            stop.check();
            const auto plane = [&](std::size_t i, std::size_t k) {
                return from.planes[source.coefficient(i, k)][pixel];
            };
            for (std::size_t i = 0; i < accumulated.size(); ++i)
                accumulated[i] = {plane(i, 0), plane(i, 1), plane(i, 2)};
            basis.fit(accumulated, c);
            for (std::size_t i = 0; i < c.size(); ++i) {
                to.planes[target.coefficient(i, 0)][pixel] = c[i].r;
                to.planes[target.coefficient(i, 1)][pixel] = c[i].g;
                to.planes[target.coefficient(i, 2)][pixel] = c[i].b;
            }
        }
    });
    return to;
}

}  // namespace

std::vector<LightmapPage> fit_pages(std::span<const LightmapPage> pages, const FittedBasis& basis, StopFlag stop) {
    std::vector<LightmapPage> fitted;
    for (const LightmapPage& page : pages) fitted.push_back(fitted_page(page, basis, stop));
    return fitted;
}

}  // namespace lobelia
