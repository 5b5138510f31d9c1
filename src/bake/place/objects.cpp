// Finds objects by name or index, and their texels.
#include "bake/place/objects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "lobelia/codec.h"

namespace lobelia {
namespace {

/// Returns the index in "#3", if that is what `name` is.
std::optional<std::size_t> index_in(const std::string& name) {
    if (name.size() < 2 || name.front() != '#') return std::nullopt;
    std::size_t index = 0;
    const char* end = name.data() + name.size();
    const auto [rest, code] = std::from_chars(name.data() + 1, end, index);
    return code == std::errc() && rest == end ? std::optional(index) : std::nullopt;
}

std::vector<std::size_t> objects_called(const World& world, const std::string& name) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < world.names.size(); ++i)
        if (world.names[i] == name) found.push_back(i);
    const auto index = index_in(name);
    if (found.empty() && index && *index < world.has_lightmap_uv.size()) found.push_back(*index);
    return found;
}

}  // namespace

Result<std::uint32_t> find_object(const World& world, const std::string& name) {
    const auto found = objects_called(world, name);
    if (found.empty()) return Error{"no object is named \"" + name + "\"" + nearest_names(name, world.names)};
    if (found.size() > 1)
        return Error{fmt::format("{} objects are named \"{}\"; select one by its index: #{}", found.size(), name,
                                 fmt::join(found, ", #"))};
    if (world.has_lightmap_uv[found.front()] == 0)
        return Error{"object \"" + name + "\" has no lightmap UVs and is not baked"};
    return static_cast<std::uint32_t>(found.front());
}

TexelMap texels_of_object(const TexelMap& map, const World& world, std::uint32_t object) {
    TexelMap result;
    for (std::size_t tile = 0; tile + 1 < map.first_of_tile.size(); ++tile) {
        const std::size_t before = result.texels.size();
        for (std::uint32_t i = map.first_of_tile[tile]; i < map.first_of_tile[tile + 1]; ++i) {
            if (world.object[map.triangle[i]] != object) continue;
            result.texels.push_back(map.texels[i]);
            result.triangle.push_back(map.triangle[i]);
        }
        if (result.texels.size() > before) result.first_of_tile.push_back(static_cast<std::uint32_t>(before));
    }
    result.first_of_tile.push_back(static_cast<std::uint32_t>(result.texels.size()));
    return result;
}

}  // namespace lobelia
