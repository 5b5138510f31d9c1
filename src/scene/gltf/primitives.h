// The triangles of a glTF primitive, and normals that a mesh lacks or spoils.
#pragma once

#include "scene/gltf/accessors.h"

namespace lobelia::gltf {

using Triangle = std::array<std::uint32_t, 3>;

/// primitive.mode, which must be valid.
[[nodiscard]] std::size_t mode_of(const JsonPlace& primitive);

/// True for triangles, strips and fans; false for points and lines.
[[nodiscard]] bool has_triangles(std::size_t mode);

/// Triangles of `primitive` over `vertices` vertices, counter-clockwise; at most `most`.
[[nodiscard]] std::vector<Triangle> read_triangles(Document& document, const JsonPlace& primitive, std::size_t vertices,
                                                   std::size_t most);

/// A triangle's normal times twice its area.
[[nodiscard]] Vec3 area_vector(const Mesh& mesh, std::size_t triangle);

/// Scales normals to length 1. Those without a direction become the mean of the triangles around them, by area, or +z
/// where there are none. Returns which they were; empty: none.
[[nodiscard]] std::vector<bool> repair_normals(Mesh& mesh);

/// True where all three normals of a triangle point away from its front: light from the front never reaches it.
[[nodiscard]] bool opposes_winding(const Mesh& mesh, std::size_t triangle);

}  // namespace lobelia::gltf
