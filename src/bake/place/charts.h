// Charts: the connected parts of the lightmap UVs.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/world.h"

namespace lobelia {

/// Returns the chart of each triangle, counted from 0 in the order of their first triangles: triangles of one object
/// are in one chart if they share a vertex, or vertices of the same position and lightmap UV. `none` if the object has
/// no lightmap UVs. Throws Stopped.
[[nodiscard]] std::vector<std::uint32_t> find_charts(const World& world, std::uint32_t none, StopFlag stop = {});

}  // namespace lobelia
