// Baked light as data: lightmap pages, the placement of objects on them, and probes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// A lightmap page: `planes` of width x height floats, row by row from the top left; PageChannels names them.
struct LightmapPage {
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::vector<float>> planes;
    /// Chart of each texel plus 1; 0: no triangle covers the texel.
    std::vector<std::uint32_t> chart;
    /// Fraction of the texel's paths that did not hit a back face first, in [0, 1]; 0 where nothing was baked.
    std::vector<float> validity;

    LightmapPage() = default;
    LightmapPage(std::size_t w, std::size_t h, std::size_t channels)
        : width(w), height(h), planes(channels, std::vector<float>(w * h)), chart(w * h), validity(w * h) {}
    [[nodiscard]] std::size_t size() const { return width * height; }
};

/// Order of a page's planes: c<i>.R, c<i>.G, c<i>.B for coefficient i; then E.R, E.G, E.B, the irradiance at the
/// shading normal as the paths measured it [W/m^2]; then E.error, the standard error of its luminance.
struct PageChannels {
    std::size_t coefficients = 0;
    [[nodiscard]] std::size_t coefficient(std::size_t i, std::size_t channel) const { return 3 * i + channel; }
    [[nodiscard]] std::size_t irradiance(std::size_t channel) const { return 3 * coefficients + channel; }
    [[nodiscard]] std::size_t error() const { return 3 * coefficients + 3; }
    [[nodiscard]] std::size_t count() const { return 3 * coefficients + 4; }
    [[nodiscard]] std::vector<std::string> names() const;
};

/// Half-open ranges of texels, [x0, x1) x [y0, y1).
struct TexelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
};

/// Placement of an object: page texel = scale * uv + offset per axis; texel centres at + 0.5, uv (0, 0) at the top
/// left.
struct AtlasPlacement {
    std::uint32_t page = 0;
    Vec2 scale, offset;
    TexelBox texels;     ///< the part of the page that the object owns (packed layout) or shares (shared layout)
    bool baked = false;  ///< the object has lightmap UVs
};

/// A regular grid: probe x + count[0] * (y + count[1] * z) belongs to origin + (x, y, z) * spacing.
struct ProbeGrid {
    std::array<std::uint32_t, 3> count{};
    Vec3 origin, spacing;
};

/// A cube of an adaptive subdivision, for interpolation between its corners; corner x + 2 y + 4 z is a probe's index.
struct ProbeCell {
    Vec3 lowest;
    float size = 0;  ///< edge length [m]
    std::array<std::uint32_t, 8> corners{};
};

/// Probes: coefficients of a basis over the sphere at points in space, in the world frame. They form a grid, cells, or
/// neither.
struct ProbeSet {
    std::string codec;                       ///< basis/encoder/evaluator
    std::size_t coefficients_per_probe = 0;  ///< size of the codec's basis
    std::vector<Vec3> positions;             ///< [m]; pushed out of walls where necessary, so not always on the grid
    std::vector<float> validity;             ///< in [0, 1]; ignore probes below one half
    std::vector<float> back_faces;           ///< fraction of paths that hit a back face first, in [0, 1]
    std::vector<Rgb> coefficients;           ///< coefficients_per_probe for each probe, one probe after another
    std::optional<ProbeGrid> grid;
    std::vector<ProbeCell> cells;
    std::size_t visibility_side = 0;  ///< texels of a side of the octahedral maps; 0: there are none
    /// Mean and mean square of the distances [m] that each probe sees: visibility_side^2 texels a probe.
    std::vector<std::array<float, 2>> visibility = {};

    [[nodiscard]] std::size_t size() const { return positions.size(); }
};

}  // namespace lobelia
