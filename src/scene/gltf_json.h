// The JSON of a glTF file, checked before anything is made of it.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "lobelia/result.h"

namespace lobelia::gltf {

/// In a mesh's extras: its TEXCOORD_1 only fills a gap, and is no lightmap's.
inline constexpr const char* k_no_lightmap = "lobelia_no_lightmap";

/// Parses it. Errors, which begin with `name`, are: JSON that is none or too deep, another version than 2, members that
/// should be arrays, objects or whole numbers and are not (with their place), required extensions that are not known.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, std::string_view name);

/// What is said of an extension that is used but not read; empty for those that are read, or do not matter to light.
[[nodiscard]] std::string_view unread_extension(std::string_view extension);

}  // namespace lobelia::gltf
