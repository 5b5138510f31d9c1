// The rest pose of a mesh: morph targets at their default weights, then the skin (glTF 2.0, 3.7.2.2 and 3.7.3.3).
#pragma once

#include "lobelia/scene.h"
#include "scene/gltf/accessors.h"
#include "scene/gltf/nodes.h"

namespace lobelia::gltf {

/// Displacements of a mesh's vertices, applied before a node places them.
struct Pose {
    std::vector<double> weights;  ///< of the morph targets; empty: all are 0
    /// Matrix from the mesh to the world of each joint, relative to the scene's origin; empty: no skin.
    std::vector<Placement> joints;
};

/// Returns the weights of a node's morph targets: the node's own or the mesh's; empty if all are 0.
[[nodiscard]] std::vector<double> morph_weights(const JsonPlace& node, const JsonPlace& mesh);

/// Returns the joint matrices of a skin: each joint's world transform times its inverse bind matrix.
[[nodiscard]] std::vector<Placement> joint_matrices(Document& document, const NodeTree& tree, std::size_t skin,
                                                    const std::array<double, 3>& origin);

/// Vertices of one primitive within a mesh: used[i] is the file's number of vertex first + i.
struct PosedVertices {
    std::size_t first = 0;
    std::span<const std::uint32_t> used;
    std::size_t count = 0;  ///< of the primitive in the file
};

/// Moves positions and normals (if the mesh has any) of these vertices. Returns a flag for each that the pose mirrors:
/// a triangle of such vertices must be reversed to keep its front in front. Empty: none.
[[nodiscard]] std::vector<bool> apply_pose(Document& document, const Pose& pose, const JsonPlace& primitive,
                                           const PosedVertices& vertices, Mesh& mesh);

}  // namespace lobelia::gltf
