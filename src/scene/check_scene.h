// Whether a scene is what scene.h promises.
#pragma once

#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

/// The first thing wrong: an index out of range, arrays of different lengths, a number that is not finite or out of its
/// range, triangles without materials. Names the place, such as "meshes[3].positions[17]".
[[nodiscard]] Status check_scene(const Scene& scene);

}  // namespace lobelia
