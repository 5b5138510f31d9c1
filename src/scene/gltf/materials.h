// Materials of a glTF file: metallic-roughness, and the extensions that change reflection or emission.
#pragma once

#include "scene/gltf/document.h"

namespace lobelia::gltf {

/// Which TEXCOORD set each of a mesh's two uv sets for textures is read from; nothing: no material needs it.
struct UvSets {
    std::array<std::optional<std::size_t>, 2> set;
};

/// Fills scene.materials and scene.textures, in the file's order; textures that no material uses are left out.
[[nodiscard]] UvSets read_materials(Document& document, Scene& scene);

/// Decodes the `used` of the file's textures, each combination of image and sampler once. Returns the index into
/// `textures` of each; nothing where it is not used or has no image.
[[nodiscard]] std::vector<std::optional<std::size_t>> read_textures(Document& document, const std::vector<bool>& used,
                                                                    std::vector<Texture>& textures);

}  // namespace lobelia::gltf
