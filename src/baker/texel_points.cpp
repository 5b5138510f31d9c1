// Interpolation on triangles.
#include "baker/texel_points.h"

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

SurfacePoint surface_of(const Atlas& atlas, const TexelMap& map, std::size_t i) {
    const std::uint32_t t = map.triangle[i];
    const PageTriangle triangle(atlas.texel_triangle(t));
    const auto weights =
        triangle.weights(anchor_of(triangle, static_cast<int>(map.texels[i].x), static_cast<int>(map.texels[i].y)));
    return {position_at(atlas.world(), t, weights), normal_at(atlas.world(), t, weights)};
}

}  // namespace lobelia
