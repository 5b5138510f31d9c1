// A spot light (KHR_lights_punctual): a cone that fades between two angles.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/light/light_kind.h"

namespace lobelia::lights {
namespace {

/// KHR_lights_punctual's falloff; equal angles make a hard edge.
float cone(const PunctualLight& light, float cosine) {
    const float inner = std::cos(light.inner_angle), outer = std::cos(light.outer_angle);
    if (!(inner > outer)) return cosine >= outer ? 1 : 0;
    const float t = std::clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
    return t * t;
}

/// Exporters write equal angles for a hard edge (three.js by default), and pi / 2 rounded up to the next float.
void read_cone(const JsonPlace& source, PunctualLight& light) {
    constexpr double k_rounding = 1e-6;
    light.outer_angle = static_cast<float>(0.25 * k_pi);
    const auto spot = source.find("spot");
    if (!spot) return;
    const auto angle = [&](const char* name, double otherwise) {
        const auto found = spot->find(name);
        return found ? found->number() : otherwise;
    };
    const double inner = angle("innerConeAngle", 0), outer = angle("outerConeAngle", 0.25 * k_pi);
    if (!(inner >= 0 && outer > 0 && inner <= outer * (1 + k_rounding) && outer <= 0.5 * k_pi * (1 + k_rounding)))
        spot->refuse("0 <= innerConeAngle <= outerConeAngle <= pi / 2 does not hold");
    light.outer_angle = static_cast<float>(std::min(outer, 0.5 * k_pi));
    light.inner_angle = std::min(static_cast<float>(inner), light.outer_angle);
}

void write_cone(const PunctualLight& light, nlohmann::json& out) {
    out["spot"] = {{"innerConeAngle", light.inner_angle}, {"outerConeAngle", light.outer_angle}};
}

std::string_view problem_of_cone(const PunctualLight& light) {
    const bool good = light.inner_angle >= 0 && light.inner_angle <= light.outer_angle && light.outer_angle > 0 &&
                      light.outer_angle <= 1.5708f;
    return good ? "" : "0 <= inner_angle <= outer_angle, 0 < outer_angle <= pi / 2 does not hold";
}

}  // namespace

constinit const LightKind spot = {.name = "spot",
                                  .aim = LightAim::along_direction,
                                  .profile = cone,
                                  .read = read_cone,
                                  .write = write_cone,
                                  .problem = problem_of_cone};

}  // namespace lobelia::lights
