// Punctual lights and cameras of a glTF file.
#pragma once

#include "scene/gltf_nodes.h"

namespace lobelia::gltf {

/// Adds them to the scene, in the order of their nodes.
[[nodiscard]] Status read_lights_and_cameras(Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace lobelia::gltf
