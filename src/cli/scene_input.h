// The scene argument of bake, render and other verbs: an embedded scene or a file, and its environment.
#pragma once

#include "lobelia/scene_source.h"

namespace CLI {
class App;
}

namespace lobelia::cli {

/// Whether the command requires SCENE.
enum class SceneArgument { required, optional };

/// Adds the argument SCENE and its options.
void add_scene_options(CLI::App& command, SceneSource& source, SceneArgument argument = SceneArgument::required);

/// Loads a scene in which at least one object has lightmap UVs.
[[nodiscard]] Result<LoadedScene> load_scene_to_bake(const SceneSource& source, const std::atomic<bool>& stop);

}  // namespace lobelia::cli
