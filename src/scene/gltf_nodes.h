// The node hierarchy of a glTF file, flattened into what stands where.
#pragma once

#include "scene/gltf_document.h"

namespace lobelia::gltf {

/// A node of the chosen scene in the world.
struct PlacedNode {
    std::size_t node = 0;
    Transform world_from_node;
};

/// The nodes of the default scene (the first where there is no default, all where there is no scene), parents before
/// children, siblings in order. An error where nodes form a cycle, or one has two parents.
[[nodiscard]] Result<std::vector<PlacedNode>> placed_nodes(Document& document);

/// Transforms relative to the node of the copies that EXT_mesh_gpu_instancing makes; one identity where it does not.
[[nodiscard]] Result<std::vector<Transform>> instances_of(Document& document, std::size_t node);

/// a after b: p is moved by b, then by a.
[[nodiscard]] Transform product(const Transform& a, const Transform& b);

}  // namespace lobelia::gltf
