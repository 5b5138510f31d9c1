// Where objects go on pages: their sizes, and their rectangles packed.
#pragma once

#include "bake/place/atlas.h"

namespace lobelia {

/// Placements of each object, and how many pages they take.
struct ObjectPlacements {
    std::vector<AtlasPlacement> placements;
    std::size_t pages = 0;
};

/// The whole page for all.
[[nodiscard]] ObjectPlacements shared_layout(const World& world, const AtlasOptions& options);
/// A rectangle for each. An error names the object that does not fit a page. Throws Stopped.
[[nodiscard]] Result<ObjectPlacements> packed_layout(const World& world, const AtlasOptions& options,
                                                     StopFlag stop = {});

}  // namespace lobelia
