// Environments for scenes that are already loaded.
#pragma once

#include "lobelia/scene_source.h"

namespace lobelia {

/// Sets the environment that `source` names and adds warnings to `scene`. Without one, the scene keeps its own.
[[nodiscard]] Status set_environment(LoadedScene& scene, const SceneSource& source);

}  // namespace lobelia
