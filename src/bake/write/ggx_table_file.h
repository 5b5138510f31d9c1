// The table of reflection lobes as a texture, for the shader code of specular evaluators.
#pragma once

#include "io/texture/container.h"

namespace lobelia {

/// Writes ggx_table() as an array texture of half floats.
[[nodiscard]] Status write_ggx_table(const TextureContainer& container, StagedFile& file);
/// The same as a file of its own; its extension names the container.
[[nodiscard]] Status write_ggx_table(const std::filesystem::path& path);

}  // namespace lobelia
