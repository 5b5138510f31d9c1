// Materials of a glTF file: metallic-roughness, and the extensions that change reflection or emission.
#pragma once

#include "scene/gltf/document.h"

namespace lobelia::gltf {

/// The TEXCOORD set of each of a mesh's two uv sets for textures; nothing: no material needs it.
struct UvSets {
    std::array<std::optional<std::size_t>, 2> set;
};

/// Fills scene.materials and scene.textures, in the file's order, without textures that no material uses.
[[nodiscard]] UvSets read_materials(Document& document, Scene& scene);

/// Decodes the `used` ones of the file's textures, each combination of image and sampler once. Returns the index into
/// `textures` of each; nothing if it is unused or has no image.
[[nodiscard]] std::vector<std::optional<std::size_t>> read_textures(Document& document, const std::vector<bool>& used,
                                                                    std::vector<Texture>& textures);

}  // namespace lobelia::gltf
