// Meshes of a glTF file: all primitives of one as triangles in one list.
#pragma once

#include "scene/gltf_materials.h"

namespace lobelia::gltf {

/// What all meshes together have used of the limits, and what their reader counted.
struct MeshTotals {
    std::size_t triangles = 0, vertices = 0;
    std::size_t no_area = 0;           ///< triangles
    std::string first_no_area;         ///< where
    std::size_t repaired_normals = 0;  ///< that were no directions
};

/// Reads meshes[index]. `default_material` is the index of the material of primitives that have none; `uses_default`
/// becomes true where there are any. Points and lines are left out: the mesh may be empty.
struct MeshContext {
    Document& document;
    UvSets uv_sets;
    std::uint32_t default_material = 0;
    bool uses_default = false;
    MeshTotals totals;
};
[[nodiscard]] Result<Mesh> read_mesh(MeshContext& context, std::size_t index);

}  // namespace lobelia::gltf
