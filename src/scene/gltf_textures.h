// Textures of a glTF file: pictures with the way they repeat.
#pragma once

#include "scene/gltf_document.h"

namespace lobelia::gltf {

/// Decodes the `used` of the file's textures. The result has the index into `textures` of each, or nothing where it is
/// not used or cannot be read without being required to (with a warning).
[[nodiscard]] Result<std::vector<std::optional<std::size_t>>> read_textures(Document& document,
                                                                            const std::vector<bool>& used,
                                                                            std::vector<Texture>& textures);

}  // namespace lobelia::gltf
