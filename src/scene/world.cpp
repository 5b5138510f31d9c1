// Converts objects in their own spaces to one list of triangles in world space.
#include "scene/world.h"

#include <algorithm>
#include <limits>

namespace lobelia {
namespace {

/// Returns `v` scaled to length 1, or `otherwise` if its length is 0.
Vec3 unit_or(Vec3 v, Vec3 otherwise) {
    const float l = length(v);
    return l > 0 && std::isfinite(l) ? v * (1 / l) : otherwise;
}

}  // namespace

float determinant(const Transform& t) { return dot(t.rows[0], cross(t.rows[1], t.rows[2])); }

Vec3 transform_normal(const Transform& t, Vec3 n) {
    // Multiply by the matrix of cofactors: the inverse transpose times the determinant, which always exists.
    const Vec3 turned{dot(cross(t.rows[1], t.rows[2]), n), dot(cross(t.rows[2], t.rows[0]), n),
                      dot(cross(t.rows[0], t.rows[1]), n)};
    return determinant(t) < 0 ? turned * -1.0f : turned;
}

Vec3 World::face_normal(std::size_t t) const {
    const auto& [a, b, c] = triangles[t];
    return unit_or(cross(positions[b] - positions[a], positions[c] - positions[a]), Vec3{});
}

std::string World::name_of(std::size_t of_object) const {
    const bool named = of_object < names.size() && !names[of_object].empty();
    return named ? "'" + names[of_object] + "'" : "object " + std::to_string(of_object);
}

namespace {

/// Appends objects to a world.
class WorldMaker {
  public:
    WorldMaker(const Scene& scene, StopFlag stop)
        : scene_(&scene),
          stop_(stop),
          colored_(
              std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return !m.colors.empty(); })) {}

    World make() {
        for (std::uint32_t i = 0; i < scene_->objects.size(); ++i) add(i);
        world_.first_triangle.push_back(static_cast<std::uint32_t>(world_.triangles.size()));
        find_box();
        return std::move(world_);
    }

  private:
    void add(std::uint32_t number) {
        stop_.check();
        const Object& object = scene_->objects[number];
        const Mesh& mesh = scene_->meshes[object.mesh];
        const Transform& place = object.world_from_object;
        const bool mirrored = determinant(place) < 0, flat = mesh.normals.empty();
        world_.first_triangle.push_back(static_cast<std::uint32_t>(world_.triangles.size()));
        world_.has_lightmap_uv.push_back(!mesh.lightmap_uv.empty());
        world_.names.push_back(object.name);

        // Smooth meshes share their vertices; flat ones get three per triangle.
        const auto base = static_cast<std::uint32_t>(world_.positions.size());
        for (std::uint32_t v = 0; !flat && v < mesh.positions.size(); ++v)
            add_vertex(object, v, unit_or(transform_normal(place, mesh.normals[v]), {0, 0, 1}));
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            std::array<std::uint32_t, 3> corners = mesh.triangles[t];
            if (mirrored) std::swap(corners[1], corners[2]);
            if (flat)
                add_flat_triangle(object, corners);
            else
                world_.triangles.push_back({base + corners[0], base + corners[1], base + corners[2]});
            world_.material.push_back(mesh.materials[t]);
            world_.object.push_back(number);
        }
    }

    void add_flat_triangle(const Object& object, const std::array<std::uint32_t, 3>& corners) {
        const auto first = static_cast<std::uint32_t>(world_.positions.size());
        const auto at = [&](std::size_t k) {
            return transform_point(object.world_from_object, scene_->meshes[object.mesh].positions[corners[k]]);
        };
        const Vec3 normal = unit_or(cross(at(1) - at(0), at(2) - at(0)), {0, 0, 1});
        for (const std::uint32_t v : corners) add_vertex(object, v, normal);
        world_.triangles.push_back({first, first + 1, first + 2});
    }

    void add_vertex(const Object& object, std::uint32_t v, Vec3 normal) {
        const Mesh& mesh = scene_->meshes[object.mesh];
        world_.positions.push_back(transform_point(object.world_from_object, mesh.positions[v]));
        world_.normals.push_back(normal);
        for (std::size_t set = 0; set < 2; ++set)
            world_.uv[set].push_back(mesh.uv[set].empty() ? Vec2{} : mesh.uv[set][v]);
        world_.lightmap_uv.push_back(mesh.lightmap_uv.empty() ? Vec2{} : mesh.lightmap_uv[v]);
        if (colored_) world_.colors.push_back(mesh.colors.empty() ? std::array<float, 4>{1, 1, 1, 1} : mesh.colors[v]);
    }

    void find_box() {
        if (world_.positions.empty()) return;
        constexpr float far = std::numeric_limits<float>::max();
        Vec3 &low = world_.lowest, &high = world_.highest;
        low = {far, far, far};
        high = {-far, -far, -far};
        for (const Vec3 p : world_.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    }

    const Scene* scene_;
    StopFlag stop_;
    bool colored_;
    World world_;
};

}  // namespace

World make_world(const Scene& scene, StopFlag stop) { return WorldMaker(scene, stop).make(); }

}  // namespace lobelia
