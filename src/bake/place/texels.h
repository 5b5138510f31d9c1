// Texels of a lightmap as receivers in the world: points on their triangles, smooth normals, and whether light can
// arrive there at all.
#pragma once

#include <vector>

#include "bake/place/atlas.h"
#include "bake/place/receiver.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Makes the receivers of texels [begin, end) of the map: the same for the same input, whatever range they are made in.
/// A texel's key is its place among all texels of all pages. `push_out` moves positions that lie closer than a texel's
/// width behind another surface to that surface's lit side.
void make_receivers(const Atlas& atlas, const TexelMap& map, std::size_t begin, std::size_t end,
                    const PathTracer& tracer, Switch push_out, std::vector<Receiver>& out);

/// Marks texels that were pushed out or are buried: 1 for each of them, page by page, row by row. Throws Stopped.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> displaced_texels(const Atlas& atlas, const TexelMap& map,
                                                                      const PathTracer& tracer, StopFlag stop = {});

/// The surface at the centre of texel i of the map, or at the covered point nearest to it.
struct TexelSurface {
    Vec3 position;
    Vec3 normal;  ///< unit, smooth
};
[[nodiscard]] TexelSurface surface_of(const Atlas& atlas, const TexelMap& map, std::size_t i);

/// Rows x, y, z: z is `normal`, x and y depend on it alone, so that charts that meet agree on them; and they change
/// with it as little as can be, so that neighbours may be averaged. No such frames exist without a pole; the only one
/// is at (-2, -3, -6) / 7, which walls, floors and ceilings do not face.
[[nodiscard]] Rotation tangent_from_world(Vec3 normal);

}  // namespace lobelia
