// Layout of objects on pages: their sizes, and their packed rectangles.
#pragma once

#include "bake/place/atlas.h"

namespace lobelia {

/// Placement of each object, and the number of pages.
struct ObjectPlacements {
    std::vector<AtlasPlacement> placements;
    std::size_t pages = 0;
};

/// Gives every object the whole page.
[[nodiscard]] ObjectPlacements shared_layout(const World& world, const AtlasOptions& options);
/// Gives each object its own rectangle. Errors: an object does not fit a page (named). Throws Stopped.
[[nodiscard]] Result<ObjectPlacements> packed_layout(const World& world, const AtlasOptions& options,
                                                     StopFlag stop = {});

}  // namespace lobelia
