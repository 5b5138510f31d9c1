// Lightmap pages as images: float channels by name, with the texels' validity and charts beside them. The finishing
// steps work on these, and files are written from them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// `channels` planes of width x height floats, row by row from the top left.
struct Page {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::vector<float>> planes;
    /// 0: nothing there; 1 and up: the texel belongs to chart number - 1, and its planes hold what was baked.
    std::vector<std::uint32_t> chart;
    /// Share of the texel's paths that did not first meet a back face, in [0, 1]; 0 where nothing was baked.
    std::vector<float> validity;

    Page() = default;
    Page(std::size_t w, std::size_t h, std::size_t channels)
        : width(w), height(h), planes(channels, std::vector<float>(w * h)), chart(w * h), validity(w * h) {}
    [[nodiscard]] std::size_t size() const { return width * height; }
};

/// Names of a page's planes, in order: c<i>.R, c<i>.G, c<i>.B for coefficient i, then the irradiance at the shading
/// normal as the paths themselves gave it, E.R, E.G, E.B [W/m^2], then E.error, the standard error of its luminance.
struct PageLayout {
    std::size_t coefficients = 0;
    [[nodiscard]] std::size_t coefficient(std::size_t i, std::size_t channel) const { return 3 * i + channel; }
    [[nodiscard]] std::size_t irradiance(std::size_t channel) const { return 3 * coefficients + channel; }
    [[nodiscard]] std::size_t error() const { return 3 * coefficients + 3; }
    [[nodiscard]] std::size_t channels() const { return 3 * coefficients + 4; }
    [[nodiscard]] std::vector<std::string> names() const;
};

}  // namespace lobelia
