// Points of texels on the triangles that own them.
#pragma once

#include "bake/place/texels.h"

namespace lobelia {

/// The triangle's point with these weights of its corners, and its smooth normal there.
[[nodiscard]] Vec3 position_at(const World& world, std::size_t triangle, const std::array<float, 3>& weights);
[[nodiscard]] Vec3 normal_at(const World& world, std::size_t triangle, const std::array<float, 3>& weights);

/// The point that stands for texel (x, y), which the triangle owns: its centre, or the covered point nearest to that.
[[nodiscard]] PagePoint anchor_of(const PageTriangle& triangle, int x, int y);

/// How far a step of one texel goes in the world [m], along the page's axis where that is more.
[[nodiscard]] float texel_width(const Atlas& atlas, std::size_t triangle);

}  // namespace lobelia
