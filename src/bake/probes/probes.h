// Light probes: coefficients of a basis over the sphere at points in space, in the world frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// A regular grid: probe x + count[0] * (y + count[1] * z) belongs to origin + (x, y, z) * spacing.
struct ProbeGrid {
    std::array<std::uint32_t, 3> count{};
    Vec3 origin, spacing;
};

/// A cube of an adaptive subdivision, between whose corners one interpolates; corner x + 2 y + 4 z is a probe's index.
struct ProbeCell {
    Vec3 lowest;
    float size = 0;  ///< of its edges [m]
    std::array<std::uint32_t, 8> corners{};
};

/// Probes of a grid, of cells, or anywhere (neither).
struct ProbeSet {
    std::string codec;                       ///< basis/encoder/evaluator
    std::size_t coefficients_per_probe = 0;  ///< of the codec's basis
    std::vector<Vec3> positions;             ///< pushed out of walls where that was needed, so not always on the grid
    std::vector<float> validity;             ///< of each, in [0, 1]; below one half it is of no use
    std::vector<float> back_faces;           ///< share of its paths that first met a back face, in [0, 1]
    std::vector<Rgb> coefficients;           ///< probe after probe
    std::optional<ProbeGrid> grid;
    std::vector<ProbeCell> cells;

    [[nodiscard]] std::size_t size() const { return positions.size(); }
};

}  // namespace lobelia
