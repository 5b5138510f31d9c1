// Edges of the world's triangles at the same position, for seams and mesh checks.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/world.h"

namespace lobelia {

/// Returns for each vertex the first one within `tolerance` [m] of it. Uses hashing; linear time. Throws Stopped.
[[nodiscard]] std::vector<std::uint32_t> weld_positions(const World& world, float tolerance, StopFlag stop = {});

/// Edge `side` (from corner `side` to the next) of a triangle; `low` and `high` are its welded ends.
struct WorldEdge {
    std::uint32_t low = 0, high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;
    [[nodiscard]] bool same_place(const WorldEdge& other) const { return low == other.low && high == other.high; }
};

/// Returns all edges whose ends differ, sorted by position, then by triangle and side.
[[nodiscard]] std::vector<WorldEdge> sorted_edges(const World& world, const std::vector<std::uint32_t>& welded);

}  // namespace lobelia
