// Points of texels on their triangles.
#pragma once

#include "bake/place/texels.h"

namespace lobelia {

/// Returns the triangle's point at these barycentric weights, and its smooth normal there.
[[nodiscard]] Vec3 position_at(const World& world, std::size_t triangle, const std::array<float, 3>& weights);
[[nodiscard]] Vec3 normal_at(const World& world, std::size_t triangle, const std::array<float, 3>& weights);

/// Returns the point that represents texel (x, y) of the triangle: its centre, or the covered point nearest to the
/// centre.
[[nodiscard]] PagePoint anchor_of(const PageTriangle& triangle, int x, int y);

/// Returns the length of one texel in the world [m]: the maximum over the page's axes.
[[nodiscard]] float texel_width(const Atlas& atlas, std::size_t triangle);

}  // namespace lobelia
