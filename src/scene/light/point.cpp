// A point light (KHR_lights_punctual): the same intensity in all directions.
#include "scene/light/light_kind.h"

namespace lobelia::lights {

constinit const LightKind point = {.name = "point"};

}  // namespace lobelia::lights
