// Texels of a lightmap as receivers in the world: points on their triangles, smooth normals, and whether light can
// reach them.
#pragma once

#include <vector>

#include "bake/place/atlas.h"
#include "bake/place/receiver.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Makes the receivers of texels [begin, end) of the map. They do not depend on the range. A texel's key is its index
/// among all texels of all pages. `push_out` moves positions that lie closer than a texel's width behind another
/// surface to that surface's lit side.
void make_receivers(const Atlas& atlas, const TexelMap& map, std::size_t begin, std::size_t end,
                    const PathTracer& tracer, Switch push_out, std::vector<Receiver>& out);

/// Marks texels that were pushed out or are buried: 1 for each of them, page by page, row by row. Throws Stopped.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> displaced_texels(const Atlas& atlas, const TexelMap& map,
                                                                      const PathTracer& tracer, StopFlag stop = {});

/// The surface at the centre of texel i of the map, or at the covered point nearest to the centre.
struct TexelSurface {
    Vec3 position;
    Vec3 normal;  ///< unit, smooth
};
[[nodiscard]] TexelSurface surface_of(const Atlas& atlas, const TexelMap& map, std::size_t i);

/// Returns the tangent frame of a normal, as rows x, y, z: z is `normal`; x and y depend on it alone, so that touching
/// charts agree, and vary with it as slowly as possible, so that neighbours may be averaged. Every such frame field has
/// a pole; this one's only pole is at (-2, -3, -6) / 7, which walls, floors and ceilings do not face.
[[nodiscard]] Rotation tangent_from_world(Vec3 normal);

}  // namespace lobelia
