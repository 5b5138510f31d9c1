// The argument that names a bake, and the scene that it was made of.
#pragma once

#include <string>

#include "bake/write/manifest.h"
#include "cli/scene_input.h"

namespace lobelia::cli {

/// Whether a path names a bake: its folder, or the bake.json in it.
[[nodiscard]] bool is_bake(const std::string& path);

/// The scene of a bake at options.path: the copy in its folder, or the embedded one of its name, in the environment of
/// the options or the bake's own.
[[nodiscard]] Result<LoadedScene> load_scene_of_bake(const SceneOptions& options, const Manifest& manifest);

}  // namespace lobelia::cli
