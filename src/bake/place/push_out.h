// Moves sample positions out of overlapping geometry: short rays along the surface search for back faces of other
// surfaces.
#pragma once

#include <span>

#include "bake/place/texels.h"

namespace lobelia {

/// Additional data of a texel for moving its positions.
struct TexelReach {
    float width = 0;                             ///< width of the texel in the world, along its longer side [m]
    std::array<Vec3, k_most_positions> normals;  ///< unit normals of the triangles that its positions lie on
};

/// Moves each position that lies behind a one-sided, opaque surface less than a texel's width away to that surface's
/// front: along its own surface to the nearest such place, or else straight up. Positions that cannot be moved and see
/// only backs are dropped; a texel that has no other keeps them and is `buried`.
void push_out(const PathTracer& tracer, std::span<const TexelReach> reach, std::span<Receiver> texels);

}  // namespace lobelia
