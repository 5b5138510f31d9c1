// Edges of the world's triangles that lie at the same place: what seams, and checks of meshes, are made of.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/world.h"

namespace lobelia {

/// For each vertex the first one that lies within `tolerance` [m] of it. Found by hashing, in linear time.
/// Throws Stopped.
[[nodiscard]] std::vector<std::uint32_t> weld_positions(const World& world, float tolerance, StopFlag stop = {});

/// Edge `side` (from corner `side` to the next) of a triangle; `low` and `high` are its welded ends.
struct WorldEdge {
    std::uint32_t low = 0, high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;
    [[nodiscard]] bool same_place(const WorldEdge& other) const { return low == other.low && high == other.high; }
};

/// All edges whose ends differ, those at the same place next to each other, then by triangle and side.
[[nodiscard]] std::vector<WorldEdge> sorted_edges(const World& world, const std::vector<std::uint32_t>& welded);

}  // namespace lobelia
