// A scene as the path tracer and the atlas use it: every object's triangles in world space, in one list.
#pragma once

#include "core/stop.h"
#include "lobelia/scene.h"

namespace lobelia {

/// Returns the determinant, negative for transforms that mirror.
[[nodiscard]] float determinant(const Transform& t);
/// Returns the direction of a surface's normal after the transform; not of unit length.
[[nodiscard]] Vec3 transform_normal(const Transform& t, Vec3 n);

/// A scene's triangles in world space. Vertex arrays are parallel; triangle arrays are parallel. Objects keep the
/// scene's order; each object's triangles are consecutive.
struct World {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< unit, smooth; the triangle's normal if the mesh has none
    std::array<std::vector<Vec2>, 2> uv;
    std::vector<Vec2> lightmap_uv;
    std::vector<std::array<float, 4>> colors;  ///< empty where no mesh has any
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> material;        ///< per triangle
    std::vector<std::uint32_t> object;          ///< per triangle
    std::vector<std::uint32_t> first_triangle;  ///< per object, and the number of all triangles at the end
    std::vector<std::uint8_t> has_lightmap_uv;  ///< per object
    std::vector<std::string> names;             ///< per object, for messages; may be empty
    Vec3 lowest, highest;                       ///< corners of the box around everything; equal if it is empty

    /// Returns "'wall'", or "object 3" if it has no name.
    [[nodiscard]] std::string name_of(std::size_t of_object) const;
    /// Returns the unit normal of triangle t by its winding; (0, 0, 0) if it has no area.
    [[nodiscard]] Vec3 face_normal(std::size_t t) const;
    /// Returns half the length of the box's diagonal [m].
    [[nodiscard]] float radius() const { return 0.5f * length(highest - lowest); }
};

/// Memory for each triangle of the world: its share of the world, Embree's tree and shading data. Measured on a million
/// triangles: about 500.
inline constexpr std::size_t k_bytes_per_triangle = 600;

/// Makes the world. Objects that mirror (a transform of negative determinant) keep their fronts in front. Flat meshes
/// get their own vertices for each triangle. Throws Stopped.
[[nodiscard]] World make_world(const Scene& scene, StopFlag stop = {});

}  // namespace lobelia
