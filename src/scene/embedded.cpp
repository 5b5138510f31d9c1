// The list of embedded scenes.
#include "scene/embedded.h"

#include <fmt/format.h>

#include <array>

namespace lobelia {
namespace {

struct Entry {
    std::string_view name;
    Scene (*make)();
};

constexpr std::array k_scenes{
    Entry{"cornell", [] { return cornell_scene(); }},
    Entry{"cornell-closed", [] { return cornell_scene({.closed = true}); }},
    Entry{"colonnade", [] { return colonnade_scene(); }},
};

constexpr auto k_names = [] {
    std::array<std::string_view, k_scenes.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = k_scenes[i].name;
    return names;
}();

}  // namespace

std::span<const std::string_view> embedded_scene_names() { return k_names; }

Result<Scene> embedded_scene(std::string_view name) {
    for (const Entry& entry : k_scenes)
        if (entry.name == name) return entry.make();
    // The terrain is too large for the list, which tests iterate over.
    if (name == "terrain") return terrain_scene();
    return Error{fmt::format("{}: no such embedded scene; there are {}", name, fmt::join(k_names, ", "))};
}

}  // namespace lobelia
