// The triangles of a glTF primitive, and repair of missing or invalid normals.
#pragma once

#include "scene/gltf/accessors.h"

namespace lobelia::gltf {

using Triangle = std::array<std::uint32_t, 3>;

/// Returns primitive.mode, refusing invalid values.
[[nodiscard]] std::size_t mode_of(const JsonPlace& primitive);

/// Returns true for triangles, strips and fans; false for points and lines.
[[nodiscard]] bool has_triangles(std::size_t mode);

/// Reads the triangles of `primitive` over `vertices` vertices, counter-clockwise; at most `most`.
[[nodiscard]] std::vector<Triangle> read_triangles(Document& document, const JsonPlace& primitive, std::size_t vertices,
                                                   std::size_t most);

/// Returns a triangle's normal times twice its area.
[[nodiscard]] Vec3 area_vector(const Mesh& mesh, std::size_t triangle);

/// Scales normals to length 1. Those without a direction become the area-weighted mean of the triangles around them, or
/// +z if there are none. Returns a flag for each that was replaced; empty: none.
[[nodiscard]] std::vector<bool> repair_normals(Mesh& mesh);

/// Returns whether all three normals of a triangle point away from its front: light from the front never reaches it.
[[nodiscard]] bool opposes_winding(const Mesh& mesh, std::size_t triangle);

}  // namespace lobelia::gltf
