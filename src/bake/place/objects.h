// Objects by name, and the texels of one object.
#pragma once

#include <string>

#include "bake/place/atlas.h"

namespace lobelia {

/// Returns the index of the object with this name, or with this index as "#3". Errors: no such object, several of the
/// name, or no lightmap UVs.
[[nodiscard]] Result<std::uint32_t> find_object(const World& world, const std::string& name);

/// Returns the part of the map that one object covers, without empty tiles.
[[nodiscard]] TexelMap texels_of_object(const TexelMap& map, const World& world, std::uint32_t object);

}  // namespace lobelia
