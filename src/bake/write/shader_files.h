// Shader code beside the textures of a bake.
#pragma once

#include <string_view>
#include <vector>

#include "bake/write/files_together.h"
#include "io/texture/container.h"
#include "lobelia/bake.h"
#include "lobelia/storage.h"

namespace lobelia {

/// Writes decode.STORAGE.glsl, .hlsl, .wgsl and .metal for each storage: the functions that unpack its textures and
/// evaluate irradiance and, where the basis has a specular evaluator, specular reflection; then also the table that
/// this samples, ggx-lobe.CONTAINER. For an evaluator without shader code it writes none and adds a warning with the
/// reason.
[[nodiscard]] Status add_shaders(FilesTogether& files, const std::vector<const Storage*>& storages,
                                 const TextureContainer& container, Manifest& manifest);

/// Returns whether a file of a bake has such a name.
[[nodiscard]] bool is_name_of_shader(std::string_view name);

}  // namespace lobelia
