// Where an edge of the world lies in two places on the pages.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bake/place/atlas.h"

namespace lobelia {

/// An edge, or a part of one, as it lies on a page, its ends in the order of their places in the world.
struct SeamSide {
    std::uint32_t triangle = 0;
    std::array<Vec2, 2> ends;       ///< [texels]
    std::array<Vec3, 2> positions;  ///< of the ends in the world
    std::array<Vec3, 2> normals;
    [[nodiscard]] double texels() const { return std::hypot(ends[1].x - ends[0].x, ends[1].y - ends[0].y); }
};
struct Seam {
    SeamSide a, b;
    [[nodiscard]] double texels() const { return std::max(a.texels(), b.texels()); }
};

/// All seams between baked triangles whose normals agree, edges that meet at T-junctions part by part. Positions within
/// `tolerance` [m] are the same.
[[nodiscard]] std::vector<Seam> find_seams(const Atlas& atlas, float tolerance, StopFlag stop = {});

}  // namespace lobelia
