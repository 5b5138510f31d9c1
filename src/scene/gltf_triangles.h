// The triangles of a glTF primitive, whatever its topology and index type.
#pragma once

#include "scene/gltf_accessors.h"

namespace lobelia::gltf {

using Triangle = std::array<std::uint32_t, 3>;

/// Whether a mode is triangles, a strip or a fan; false for points and lines.
[[nodiscard]] bool has_triangles(int mode);

/// Triangles of `primitive` over `vertices` vertices, counter-clockwise; at most `most`, or an error.
[[nodiscard]] Result<std::vector<Triangle>> read_triangles(Document& document, const tinygltf::Primitive& primitive,
                                                           std::size_t vertices, std::size_t most,
                                                           const std::string& place);

}  // namespace lobelia::gltf
