// Cameras as they are named on the command line.
#pragma once

#include <string>

#include "lobelia/result.h"
#include "scene/world.h"

namespace lobelia::cli {

/// The scene's camera of that name or number, or one from "px,py,pz,tx,ty,tz[,fov]" (metres, degrees from bottom to
/// top). Where the scene has no camera, number 0 sees all of it.
[[nodiscard]] Result<Camera> find_camera(const Scene& scene, const std::string& text);

}  // namespace lobelia::cli
