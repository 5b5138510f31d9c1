// Small scenes shared by tests of the bake.
#pragma once

#include "scene/world.h"

namespace lobelia::test {

/// A parallelogram at `corner` with edges `a` and `b`, lightmap UVs over the square [low, high]^2, normals a x b.
inline Mesh parallelogram(Vec3 corner, Vec3 a, Vec3 b, Vec2 low = {0, 0}, Vec2 high = {1, 1}) {
    Mesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.normals.assign(4, normalize(cross(a, b)));
    mesh.lightmap_uv = {low, {high.x, low.y}, high, {low.x, high.y}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.materials = {0, 0};
    return mesh;
}

/// A flat mesh of free triangles in the plane z = 0, whose lightmap UVs are its x and y.
inline Mesh flat_triangles(const std::vector<std::array<Vec2, 3>>& triangles) {
    Mesh mesh;
    for (const auto& corners : triangles) {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec2 p : corners) {
            mesh.positions.push_back({p.x, p.y, 0});
            mesh.normals.push_back({0, 0, 1});
            mesh.lightmap_uv.push_back(p);
        }
        mesh.triangles.push_back({base, base + 1, base + 2});
        mesh.materials.push_back(0);
    }
    return mesh;
}

/// A scene with each mesh as an object of its own, all of one white material.
inline Scene scene_of(std::vector<Mesh> meshes) {
    Scene scene;
    scene.materials.emplace_back();
    scene.meshes = std::move(meshes);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) scene.objects.push_back({{}, i, {}});
    return scene;
}

/// Puts the mesh's lightmap UVs at scale * uv + offset.
inline Mesh with_uv(Mesh mesh, float scale, Vec2 offset) {
    for (Vec2& uv : mesh.lightmap_uv) uv = uv * scale + offset;
    return mesh;
}

/// The mesh as one that is not baked.
inline Mesh without_lightmap(Mesh mesh) {
    mesh.lightmap_uv.clear();
    return mesh;
}

/// A n x n grid over the unit square of the xy plane, height(x, y) above it; smooth vertices shared, UVs x and y.
template <class Height>
Mesh height_field(std::uint32_t n, const Height& height) {
    Mesh mesh;
    const float step = 1 / static_cast<float>(n);
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const float x = static_cast<float>(i) * step, y = static_cast<float>(j) * step, e = 1e-3f;
            mesh.positions.push_back({x, y, height(x, y)});
            mesh.normals.push_back(normalize(Vec3{(height(x - e, y) - height(x + e, y)) / (2 * e),
                                                  (height(x, y - e) - height(x, y + e)) / (2 * e), 1}));
            mesh.lightmap_uv.push_back({x, y});
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    mesh.materials.assign(mesh.triangles.size(), 0);
    return mesh;
}

}  // namespace lobelia::test
