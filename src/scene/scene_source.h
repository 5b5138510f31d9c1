// Environments of scenes that are already there.
#pragma once

#include "io/read_file.h"
#include "lobelia/scene_source.h"

namespace lobelia {

/// Reads the scene of a folder that others may have filled: source.path must be a file, not a symbolic link.
/// `environment` says whether source.environment may be one.
[[nodiscard]] Result<LoadedScene> load_scene_copy(const SceneSource& source, InputOptions::Links environment);

/// Sets the environment that `source` asks for and adds warnings to `scene`. Without one, the scene keeps its own.
[[nodiscard]] Status set_environment(LoadedScene& scene, const SceneSource& source,
                                     InputOptions::Links links = InputOptions::Links::followed);

}  // namespace lobelia
