// Meshes of a glTF file: all primitives of one as triangles in one list.
#pragma once

#include "scene/gltf/materials.h"
#include "scene/gltf/pose.h"

namespace lobelia::gltf {

/// Something that several triangles or normals have wrong: reported once, with the first of them.
struct Tally {
    std::size_t count = 0;
    std::string first;
};

/// The use of the limits by all meshes together, and what is to be reported about them.
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
