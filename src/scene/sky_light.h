// The procedural sky as a scene's light: an image without the sun's disc, and the sun as a directional light.
#pragma once

#include "lobelia/scene.h"
#include "lobelia/sky.h"

namespace lobelia {

/// Replaces the scene's environment by `sky` and its directional lights by the sun, which has the angular radius of
/// its disc and the irradiance that the disc gives. The image has `height` rows and twice as many columns.
/// Preconditions: check(sky), height >= 1.
void set_sky(Scene& scene, const SkyOptions& sky, std::size_t height = 256);

}  // namespace lobelia
