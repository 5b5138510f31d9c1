// Checks a scene against the promises of scene.h.
#pragma once

#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

/// Returns the first fault: an index out of range, arrays of different lengths, a number that is not finite or out of
/// its range, triangles without materials. The message names the place, such as "meshes[3].positions[17]".
[[nodiscard]] Status check_scene(const Scene& scene);

}  // namespace lobelia
