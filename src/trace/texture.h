// Texture lookups: wrapped, filtered, decoded by table.
#pragma once

#include "lobelia/scene.h"

namespace lobelia {

/// Encoding of a texture's bytes: linear, or sRGB colours (alpha is always linear).
enum class Curve { linear, srgb };

/// Returns the value at uv (0, 0: top left of the image; texel centres at + 0.5), each channel in [0, 1].
[[nodiscard]] std::array<float, 4> texture_value(const Texture& texture, Vec2 uv, Curve curve);

/// Returns the texture coordinates of a use, from the mesh's uv of its set.
[[nodiscard]] constexpr Vec2 texture_uv(const TextureUse& use, Vec2 mesh_uv) {
    const auto& m = use.uv_from_mesh;
    return {m[0][0] * mesh_uv.x + m[0][1] * mesh_uv.y + m[0][2], m[1][0] * mesh_uv.x + m[1][1] * mesh_uv.y + m[1][2]};
}

}  // namespace lobelia
