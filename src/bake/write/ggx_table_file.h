// The table of reflection lobes as a texture, for the shader code of specular evaluators.
#pragma once

#include "io/texture/container.h"

namespace lobelia {

/// Writes ggx_table() as an array texture of half floats.
[[nodiscard]] Status write_ggx_table(const TextureContainer& container, StagedFile& file);
/// Stages a file of its own, flushed; its extension names the container.
[[nodiscard]] Result<StagedFile> stage_ggx_table(const std::filesystem::path& path);

}  // namespace lobelia
