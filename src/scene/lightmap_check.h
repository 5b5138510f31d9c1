// Whether lightmap UVs can be baked: inside the unit square, and no two surfaces on the same place.
#pragma once

#include "scene/world.h"

namespace lobelia {

struct LightmapCheck {
    std::size_t outside = 0;              ///< vertices beyond the unit square
    std::size_t covered = 0;              ///< points of the grid that a triangle covers
    std::size_t overlapping = 0;          ///< those that several cover
    std::uint32_t first_overlapping = 0;  ///< triangle, where there is any
};

/// Looks at grid x grid points of the unit square, and at the triangles of objects [first, last) that have lightmap
/// UVs. Overlaps narrower than the grid's spacing may be missed.
[[nodiscard]] LightmapCheck check_lightmap(const World& world, std::size_t first, std::size_t last,
                                           std::size_t grid = 1024);

}  // namespace lobelia
