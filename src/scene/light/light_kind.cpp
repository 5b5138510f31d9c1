// The kinds of lights by the list.
#include "scene/light/light_kind.h"

#include <array>

namespace lobelia {
namespace {

#define LOBELIA_ENTRY(name) &lights::name,
constexpr std::array k_entries = {LOBELIA_LIGHT_KINDS(LOBELIA_ENTRY)};
#undef LOBELIA_ENTRY

#define LOBELIA_KIND(name) PunctualLight::Kind::name,
constexpr std::array k_kinds = {LOBELIA_LIGHT_KINDS(LOBELIA_KIND)};
#undef LOBELIA_KIND

}  // namespace

const LightKind& light_kind(PunctualLight::Kind kind) { return *k_entries[static_cast<std::size_t>(kind)]; }

std::span<const PunctualLight::Kind> light_kinds() { return k_kinds; }

}  // namespace lobelia
