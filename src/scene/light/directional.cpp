// A directional light (KHR_lights_punctual): a parallel beam, or a disc in the sky, such as the sun.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scene/light/light_kind.h"

namespace lobelia::lights {
namespace {

/// glTF has no size for it: our own files carry one in the extras.
void read_disc(const JsonPlace& source, PunctualLight& light) {
    const auto extras = source.find("extras");
    const auto radius = extras && extras->is_object() ? extras->find("angular_radius") : std::nullopt;
    if (radius && !(radius->number() >= 0 && radius->number() < 0.5 * k_pi))
        radius->refuse(fmt::format("{} is not in [0, pi / 2)", radius->number()));
    if (radius) light.angular_radius = static_cast<float>(radius->number());
}

void write_disc(const PunctualLight& light, nlohmann::json& out) {
    if (light.angular_radius > 0) out["extras"]["angular_radius"] = light.angular_radius;
}

}  // namespace

constinit const LightKind directional = {.name = "directional",
                                         .place = LightPlace::far,
                                         .aim = LightAim::along_direction,
                                         .read = read_disc,
                                         .write = write_disc};

}  // namespace lobelia::lights
