// Seams: edges of the mesh that lie at two places on the lightmap pages.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bake/place/atlas.h"

namespace lobelia {

/// An edge or part of one on a page, with its ends ordered by their positions in the world.
struct SeamSide {
    std::uint32_t triangle = 0;
    std::array<Vec2, 2> ends;       ///< [texels]
    std::array<Vec3, 2> positions;  ///< positions of the ends in the world
    std::array<Vec3, 2> normals;
    [[nodiscard]] double texels() const { return std::hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y); }
};
struct Seam {
    SeamSide a, b;
    [[nodiscard]] double texels() const { return std::max(a.texels(), b.texels()); }
};

/// Returns all seams between baked triangles whose normals agree; edges that meet at T-junctions are joined part by
/// part. Positions within `tolerance` [m] are equal.
[[nodiscard]] std::vector<Seam> find_seams(const Atlas& atlas, float tolerance, StopFlag stop = {});

}  // namespace lobelia
