// From objects in their own spaces to one list of triangles.
#include "scene/world.h"

#include <algorithm>
#include <limits>

namespace lobelia {
namespace {

float determinant(const Transform& t) { return dot(t.rows[0], cross(t.rows[1], t.rows[2])); }

/// Normals are turned by the matrix of cofactors: the inverse transpose times the determinant, which always exists.
Vec3 transform_normal(const Transform& t, Vec3 n) {
    const Vec3 turned{dot(cross(t.rows[1], t.rows[2]), n), dot(cross(t.rows[2], t.rows[0]), n),
                      dot(cross(t.rows[0], t.rows[1]), n)};
    return determinant(t) < 0 ? turned * -1.0f : turned;
}

/// `v` scaled to length 1, or `otherwise` where it has none.
Vec3 unit_or(Vec3 v, Vec3 otherwise) {
    const float l = length(v);
    return l > 0 && std::isfinite(l) ? v * (1 / l) : otherwise;
}

}  // namespace

Vec3 World::face_normal(std::size_t t) const {
    const auto& [a, b, c] = triangles[t];
    return unit_or(cross(positions[b] - positions[a], positions[c] - positions[a]), Vec3{});
}

std::string World::name_of(std::size_t of_object) const {
    const bool named = of_object < names.size() && !names[of_object].empty();
    return named ? "'" + names[of_object] + "'" : "object " + std::to_string(of_object);
}

World make_world(const Scene& scene) {
    World world;
    const bool colored =
        std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return !m.colors.empty(); });
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Mesh& mesh = scene.meshes[object.mesh];
        const bool mirrored = determinant(object.world_from_object) < 0, flat = mesh.normals.empty();
        world.first_triangle.push_back(static_cast<std::uint32_t>(world.triangles.size()));
        world.has_lightmap_uv.push_back(!mesh.lightmap_uv.empty());
        world.names.push_back(object.name);

        const auto add_vertex = [&](std::uint32_t v, Vec3 normal) {
            world.positions.push_back(transform_point(object.world_from_object, mesh.positions[v]));
            world.normals.push_back(normal);
            for (std::size_t set = 0; set < 2; ++set)
                world.uv[set].push_back(mesh.uv[set].empty() ? Vec2{} : mesh.uv[set][v]);
            world.lightmap_uv.push_back(mesh.lightmap_uv.empty() ? Vec2{} : mesh.lightmap_uv[v]);
            if (colored)
                world.colors.push_back(mesh.colors.empty() ? std::array<float, 4>{1, 1, 1, 1} : mesh.colors[v]);
        };

        // Smooth meshes share their vertices; flat ones get three for each triangle, below.
        const auto base = static_cast<std::uint32_t>(world.positions.size());
        if (!flat)
            for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
                add_vertex(v, unit_or(transform_normal(object.world_from_object, mesh.normals[v]), {0, 0, 1}));

        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            std::array<std::uint32_t, 3> corners = mesh.triangles[t];
            if (mirrored) std::swap(corners[1], corners[2]);
            if (flat) {
                const auto first = static_cast<std::uint32_t>(world.positions.size());
                const auto at = [&](std::size_t k) {
                    return transform_point(object.world_from_object, mesh.positions[corners[k]]);
                };
                const Vec3 normal = unit_or(cross(at(1) - at(0), at(2) - at(0)), {0, 0, 1});
                for (std::uint32_t v : corners) add_vertex(v, normal);
                world.triangles.push_back({first, first + 1, first + 2});
            } else {
                world.triangles.push_back({base + corners[0], base + corners[1], base + corners[2]});
            }
            world.material.push_back(mesh.materials[t]);
            world.object.push_back(static_cast<std::uint32_t>(i));
        }
    }
    world.first_triangle.push_back(static_cast<std::uint32_t>(world.triangles.size()));

    if (world.positions.empty()) return world;
    constexpr float far = std::numeric_limits<float>::max();
    world.lowest = {far, far, far};
    world.highest = {-far, -far, -far};
    for (const Vec3 p : world.positions) {
        world.lowest = {std::min(world.lowest.x, p.x), std::min(world.lowest.y, p.y), std::min(world.lowest.z, p.z)};
        world.highest = {std::max(world.highest.x, p.x), std::max(world.highest.y, p.y),
                         std::max(world.highest.z, p.z)};
    }
    return world;
}

}  // namespace lobelia
