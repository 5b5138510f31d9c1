// Checks that lightmap UVs can be baked: inside the unit square, and without overlap.
#pragma once

#include "scene/world.h"

namespace lobelia {

struct LightmapCheck {
    std::size_t outside = 0;              ///< vertices beyond the unit square
    std::size_t covered = 0;              ///< points of the grid that a triangle covers
    std::size_t overlapping = 0;          ///< covered points that several triangles cover
    std::uint32_t first_overlapping = 0;  ///< a triangle, if there is any overlap
};

/// Tests grid x grid points of the unit square against the triangles of objects [first, last) that have lightmap UVs.
/// May miss overlaps narrower than the grid's spacing.
[[nodiscard]] LightmapCheck check_lightmap(const World& world, std::size_t first, std::size_t last,
                                           std::size_t grid = 1024);

}  // namespace lobelia
