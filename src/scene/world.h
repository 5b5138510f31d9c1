// A scene as the path tracer and the atlas see it: every object's triangles in world space, in one list.
#pragma once

#include "core/stop.h"
#include "lobelia/scene.h"

namespace lobelia {

/// Negative for transforms that mirror.
[[nodiscard]] float determinant(const Transform& t);
/// The direction of a surface's normal after the surface is moved; not of unit length.
[[nodiscard]] Vec3 transform_normal(const Transform& t, Vec3 n);

/// Vertex arrays are parallel; triangle arrays are parallel. Objects keep the scene's order, their triangles lie
/// together.
struct World {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< unit, smooth; of the triangle where the mesh has none
    std::array<std::vector<Vec2>, 2> uv;
    std::vector<Vec2> lightmap_uv;
    std::vector<std::array<float, 4>> colors;  ///< empty where no mesh has any
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> material;        ///< of each triangle
    std::vector<std::uint32_t> object;          ///< of each triangle
    std::vector<std::uint32_t> first_triangle;  ///< of each object, and the number of all triangles at the end
    std::vector<std::uint8_t> has_lightmap_uv;  ///< of each object
    std::vector<std::string> names;             ///< of each object, for messages; may be empty
    Vec3 lowest, highest;                       ///< corners of the box around everything; equal where there is nothing

    /// "'wall'", or "object 3" where it has no name.
    [[nodiscard]] std::string name_of(std::size_t of_object) const;
    /// Unit normal of triangle t by its winding, (0, 0, 0) where it has no area.
    [[nodiscard]] Vec3 face_normal(std::size_t t) const;
    /// Half the length of the box's diagonal [m].
    [[nodiscard]] float radius() const { return 0.5f * length(highest - lowest); }
};

/// Memory for each triangle of the world: its share of the world, Embree's tree and shading data. Measured on a million
/// triangles: about 500.
inline constexpr std::size_t k_bytes_per_triangle = 600;

/// Objects that mirror (a transform of negative determinant) keep their fronts in front. Flat meshes get vertices of
/// their own for each triangle. Throws Stopped.
[[nodiscard]] World make_world(const Scene& scene, StopFlag stop = {});

}  // namespace lobelia
