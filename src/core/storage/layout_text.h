// Layouts as text: JSON for programs that write shaders or files from them, lines for people.
#pragma once

#include "lobelia/texture_layout.h"

namespace lobelia {

/// {"coefficients": n, "textures": [{"name", "format", "vk_format", "subsampling", "channels": [{"coefficient",
/// "component", "form", "scale", "offset"}]}]}: the fields of TextureLayout by their names. `component` is "r", "g",
/// "b", "luma", "chroma_orange" or "chroma_green", `form` is "value" or "ratio".
[[nodiscard]] std::string layout_json(const TextureLayout& layout);

/// One of the "textures".
[[nodiscard]] std::string texture_json(const TextureLayout::Texture& texture);

/// Returns the formula of a channel, such as "c1.r" or "0.5 + 0.288675 c1.r / c0.r".
[[nodiscard]] std::string channel_text(const StoredChannel& channel);

/// Returns the formulae of a texture's channels, a line each.
[[nodiscard]] std::string channels_text(const TextureLayout::Texture& texture);

[[nodiscard]] std::string_view component_name(Component component);

}  // namespace lobelia
