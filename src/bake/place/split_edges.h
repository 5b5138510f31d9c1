// Splits edges where others end on them: at T-junctions the parts then lie at the same position.
#pragma once

#include <span>

#include "bake/place/edges.h"

namespace lobelia {

/// A part of edge `side` of a triangle, between the welded vertices `low` and `high`; `at_low` and `at_high` say where
/// these lie along the edge, 0 at corner `side` and 1 at the next.
struct EdgePiece {
    std::uint32_t low = 0, high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;
    float at_low = 0, at_high = 1;
    [[nodiscard]] bool same_place(const EdgePiece& other) const { return low == other.low && high == other.high; }
};

/// Returns the whole edge as one piece.
[[nodiscard]] EdgePiece whole_piece(const World& world, const std::vector<std::uint32_t>& welded,
                                    const WorldEdge& edge);

/// Splits whole pieces at each end of another one that lies within `tolerance` [m] of their inside. The order is that
/// of sorted_edges. Time and memory are linear in the number of pieces for ordinary meshes, and bounded for any: beyond
/// the limits, pieces stay whole. Throws Stopped.
[[nodiscard]] std::vector<EdgePiece> split_edges(const World& world, std::span<const EdgePiece> pieces, float tolerance,
                                                 StopFlag stop = {});

}  // namespace lobelia
