// A kind of light without a surface: how it shines, and how glTF files describe it. Each kind is defined in a file of
// its own, src/scene/light/NAME.cpp; the list is LOBELIA_LIGHT_KINDS in scene.h.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

#include "io/json.h"
#include "lobelia/scene.h"

namespace lobelia {

/// Near lights have a position, and their light falls with the square of the distance; far ones are in the sky.
enum class LightPlace { near, far };
/// Light in all directions alike, or about PunctualLight::direction.
enum class LightAim { everywhere, along_direction };

struct LightKind {
    std::string_view name;  ///< "type" in KHR_lights_punctual
    LightPlace place = LightPlace::near;
    LightAim aim = LightAim::everywhere;
    /// Fraction of the intensity, in [0, 1], that leaves a near light at this cosine to its direction; null: all of it.
    float (*profile)(const PunctualLight& light, float cosine) = nullptr;
    /// Reads the fields that only this kind has from its object in a glTF file, and refuses wrong ones; null: none.
    void (*read)(const JsonPlace& source, PunctualLight& light) = nullptr;
    /// Writes what `read` reads.
    void (*write)(const PunctualLight& light, nlohmann::json& out) = nullptr;
    /// Says what is wrong with the fields of this kind; empty: nothing. Intensity, position, direction and range are
    /// checked for all kinds.
    std::string_view (*problem)(const PunctualLight& light) = nullptr;
};

namespace lights {

// lights::point and so on, each defined in the file of its kind.
#define LOBELIA_DECLARE_KIND(name) extern const LightKind name;
LOBELIA_LIGHT_KINDS(LOBELIA_DECLARE_KIND)
#undef LOBELIA_DECLARE_KIND

}  // namespace lights

[[nodiscard]] const LightKind& light_kind(PunctualLight::Kind kind);
/// All kinds, in the order of the list.
[[nodiscard]] std::span<const PunctualLight::Kind> light_kinds();

}  // namespace lobelia
