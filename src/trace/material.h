// How a surface reflects: glTF's metallic-roughness model, as diffuse reflection under a GGX layer. The model is taken
// as it is specified: at grazing angles base and layer may together reflect up to a third more than arrives.
// Khronos 2021 (the model); Walter et al. 2007, Heitz 2014 (GGX); Heitz 2018 (visible normals); Schlick 1994.
#pragma once

#include <algorithm>

#include "core/sample/sequence.h"
#include "lobelia/math.h"
#include "lobelia/scene.h"

namespace lobelia {

[[nodiscard]] constexpr Rgb product(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
[[nodiscard]] constexpr float largest(Rgb a) { return std::max({a.r, a.g, a.b}); }
[[nodiscard]] constexpr bool is_black(Rgb a) { return a.r == 0 && a.g == 0 && a.b == 0; }

/// A point's reflection. Fresnel factors go from `at_0` (light along the half vector) to `at_90` by Schlick's power.
struct Reflectance {
    Rgb diffuse;             ///< what the base reflects, before the layer's share is taken off it
    Rgb layer_0;             ///< the layer's Fresnel factor at 0 degrees
    float layer_90 = 0;      ///< and at 90
    float taken_0 = 0;       ///< largest share of the light that the layer keeps from the diffuse base, at 0 degrees
    float taken_90 = 0;      ///< and at 90
    float width = 1;         ///< GGX's alpha, roughness squared
    bool has_layer = false;  ///< otherwise it is diffuse alone
};

/// The factors after textures: `base` colour, metallic, roughness, with the material's constants.
[[nodiscard]] Reflectance make_reflectance(const Material& material, Rgb base, float metallic, float roughness);

/// A direction that a surface scatters to, in the frame whose z is the normal, as seen from `wo`.
struct Scattered {
    Vec3 wi;
    Rgb weight;     ///< reflectance times cosine over pdf
    float pdf = 0;  ///< [1/sr]; 0: absorbed
};

/// What a surface reflects from one direction into another, and with which density `scatter` chooses it.
struct Reflected {
    Rgb value;      ///< the reflectance distribution [1/sr] times the cosine of wi
    float pdf = 0;  ///< [1/sr]
};

/// Sample, and value with pdf, of one model; directions in the frame whose z is the normal, wo.z > 0. `choice` in [0,
/// 1) selects the layer or the base.
[[nodiscard]] Scattered scatter(const Reflectance& surface, Vec3 wo, Pair point, float choice);
/// Albedo of the base under the layer, for light from wi: the base's part of reflected() is this times cosine over pi.
[[nodiscard]] Rgb base_albedo(const Reflectance& surface, Vec3 wo, Vec3 wi);
[[nodiscard]] Reflected reflect(const Reflectance& surface, Vec3 wo, Vec3 wi);

}  // namespace lobelia
