// Interpolation on triangles.
#include "bake/place/texel_points.h"

#include <algorithm>
#include <cmath>

namespace lobelia {

Vec3 position_at(const World& world, std::size_t triangle, const std::array<float, 3>& weights) {
    const auto& [a, b, c] = world.triangles[triangle];
    return world.positions[a] * weights[0] + world.positions[b] * weights[1] + world.positions[c] * weights[2];
}

Vec3 normal_at(const World& world, std::size_t triangle, const std::array<float, 3>& weights) {
    const auto& [a, b, c] = world.triangles[triangle];
    const Vec3 n = world.normals[a] * weights[0] + world.normals[b] * weights[1] + world.normals[c] * weights[2];
    if (const float l = length(n); l > 1e-6f) return n * (1 / l);
    const Vec3 face = world.face_normal(triangle);
    return dot(face, face) > 0 ? face : world.normals[a];
}

PagePoint anchor_of(const PageTriangle& triangle, int x, int y) {
    const PagePoint centre{x + 0.5, y + 0.5};
    return triangle.contains(centre) ? centre : triangle.part_in(x, y).nearest(centre);
}

float texel_width(const Atlas& atlas, std::size_t triangle) {
    // Position and page are linear in the same two weights: d position / d page = edges * (page edges)^-1.
    const World& world = atlas.world();
    const auto& [a, b, c] = world.triangles[triangle];
    const Vec3 e1 = world.positions[b] - world.positions[a], e2 = world.positions[c] - world.positions[a];
    const auto page = atlas.texel_triangle(triangle);
    const Vec2 f1 = page[1] - page[0], f2 = page[2] - page[0];
    const float determinant = f1.x * f2.y - f1.y * f2.x;
    const float along_x = length(e1 * f2.y - e2 * f1.y), along_y = length(e2 * f1.x - e1 * f2.x);
    const float width = std::max(along_x, along_y) / std::abs(determinant);
    return std::isfinite(width) ? width : 0;
}

TexelSurface surface_of(const Atlas& atlas, const TexelMap& map, std::size_t i) {
    const std::uint32_t t = map.triangle[i];
    const PageTriangle triangle(atlas.texel_triangle(t));
    const auto weights =
        triangle.weights(anchor_of(triangle, static_cast<int>(map.texels[i].x), static_cast<int>(map.texels[i].y)));
    return {position_at(atlas.world(), t, weights), normal_at(atlas.world(), t, weights)};
}

}  // namespace lobelia
