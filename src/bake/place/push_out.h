// Positions that other geometry has buried, moved to where there is light: short rays along the surface look for the
// backs of others.
#pragma once

#include <span>

#include "bake/place/texels.h"

namespace lobelia {

/// What is known of a texel besides when its positions are moved.
struct TexelReach {
    float width = 0;                             ///< of the texel in the world, along its longer side [m]
    std::array<Vec3, k_most_positions> normals;  ///< of the triangles that its positions lie on, unit
};

/// Moves each position that lies behind a one-sided, opaque surface less than a texel's width away to that surface's
/// front: along its own surface to the nearest such place, or else straight up. Positions that cannot be moved and see
/// only backs are dropped; a texel that has no other keeps them and is `buried`.
void push_out(const PathTracer& tracer, std::span<const TexelReach> reach, std::span<Receiver> texels);

}  // namespace lobelia
