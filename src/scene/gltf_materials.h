// Materials and textures of a glTF file.
#pragma once

#include "scene/gltf_document.h"

namespace lobelia::gltf {

/// Which TEXCOORD set each of a mesh's two uv sets for textures is read from; nothing: no material needs it.
struct UvSets {
    std::array<std::optional<std::size_t>, 2> set;
};

/// Fills scene.materials, in the file's order, and scene.textures with those that they use, in the file's order, each
/// pair of image and wrap modes once.
[[nodiscard]] Result<UvSets> read_materials(Document& document, Scene& scene);

}  // namespace lobelia::gltf
