// Lightmap pages as textures for GPUs: the coefficients in a packing of their basis, validity in alpha.
#pragma once

#include <string>

#include "baker/bake/pages.h"
#include "io/staged_file.h"
#include "lobelia/texture_packing.h"

namespace lobelia {

/// Writes array number `array` of the packing's textures as KTX 2.0. `origin` is a text for whoever finds the file
/// alone: codec and frame.
[[nodiscard]] Status write_page_texture(StagedFile& file, const Page& page, const TexturePacking& packing,
                                        std::size_t array, const std::string& origin);

/// In file names and manifests: half or unorm8.
[[nodiscard]] const char* format_name(TexelFormat format);

}  // namespace lobelia
