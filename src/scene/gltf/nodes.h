// The node hierarchy of a glTF file, flattened.
#pragma once

#include <array>

#include "scene/gltf/document.h"

namespace lobelia::gltf {

/// An affine transform: p becomes rows * (p, 1). Double precision, because scenes may lie far from their origin.
struct Placement {
    std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
};

/// Composes transforms: b is applied first, then a.
[[nodiscard]] Placement product(const Placement& a, const Placement& b);

/// Returns the same transform in single precision, with `origin` moved to zero.
[[nodiscard]] Transform relative_to(const std::array<double, 3>& origin, const Placement& placement);

struct NodeTree {
    std::vector<std::optional<std::size_t>> parent;  ///< of each node
    std::vector<Placement> world_from_node;          ///< of each node
    /// The visible nodes of the default scene (the first where there is no default, all nodes where there is no scene):
    /// parents before children, siblings in order. Their placements are finite.
    std::vector<std::size_t> shown;
};

/// Reads all nodes. Refuses nodes that form a cycle, and nodes with two parents.
[[nodiscard]] NodeTree read_nodes(Document& document);

/// Returns the index of the default scene, if there is any scene.
[[nodiscard]] std::optional<std::size_t> default_scene(const Document& document);

/// Returns the placements, relative to the node, of the copies that EXT_mesh_gpu_instancing makes; without it, one
/// identity.
[[nodiscard]] std::vector<Placement> instances_of(Document& document, const JsonPlace& node);

/// Returns the name of a node after those of its ancestors that have one: "house/door".
[[nodiscard]] std::string name_path(const Document& document, const NodeTree& tree, std::size_t node);

/// Adds the lights and cameras of the shown nodes to the scene, in the order of the nodes.
void read_lights_and_cameras(Document& document, const NodeTree& tree, Scene& scene);

}  // namespace lobelia::gltf
