// Meshes of a glTF file: all primitives of a mesh as triangles in one list.
#pragma once

#include "scene/gltf/materials.h"
#include "scene/gltf/pose.h"

namespace lobelia::gltf {

/// A fault of several triangles or normals: reported once, with the first of them.
struct Tally {
    std::size_t count = 0;
    std::string first;
};

/// Totals of all meshes, for limits and reports.
struct MeshTotals {
    std::size_t triangles = 0, vertices = 0;
    Tally no_area, opposed_normals;     ///< triangles
    std::size_t repaired_normals = 0;   ///< normals without a direction
    std::vector<JsonPlace> without_uv;  ///< primitives that lack the lightmap UVs that others of their mesh have
};

struct MeshContext {
    Document& document;
    UvSets uv_sets;
    std::uint32_t default_material = 0;  ///< the index of the material of primitives that have none
    bool uses_default = false;           ///< becomes true where there are any
    MeshTotals totals;
};

/// Reads meshes[index] in a pose. Points, lines and primitives without positions are left out: the mesh may be empty.
[[nodiscard]] Mesh read_mesh(MeshContext& context, std::size_t index, const Pose& pose = {});

}  // namespace lobelia::gltf
