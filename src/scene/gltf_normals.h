// Normals that a file lacks or spoils, from the triangles around them.
#pragma once

#include "lobelia/scene.h"

namespace lobelia::gltf {

/// A triangle's normal times twice its area.
[[nodiscard]] Vec3 area_vector(const Mesh& mesh, std::size_t triangle);

/// Scales normals to length 1. Those that are no directions become the mean of the triangles around them, by area, or
/// +z where there are none. Returns which they were; empty: none.
[[nodiscard]] std::vector<bool> repair_normals(Mesh& mesh);

}  // namespace lobelia::gltf
