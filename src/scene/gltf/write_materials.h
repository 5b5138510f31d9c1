// Writes materials and textures into a glTF file.
#pragma once

#include "lobelia/scene.h"
#include "scene/gltf/glb_builder.h"

namespace lobelia::gltf {

/// Destination of a mesh's second set of texture coordinates: TEXCOORD_1 if it is the lightmap's, else _2.
struct WriteSets {
    std::size_t second_uv = 1;
};

[[nodiscard]] Status write_textures(GlbBuilder& builder, const Scene& scene);
[[nodiscard]] Status write_materials(GlbBuilder& builder, const Scene& scene, const WriteSets& sets);

}  // namespace lobelia::gltf
