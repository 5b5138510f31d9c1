// Surface reflection: glTF's metallic-roughness model, diffuse reflection under a GGX layer. The model is implemented
// as specified: at grazing angles base and layer together may reflect up to a third more light than arrives.
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

/// Reflectance of a shading point. Fresnel factors go from `at_0` (light along the half vector) to `at_90` by Schlick's
/// approximation.
struct Reflectance {
    Rgb diffuse;             ///< albedo of the base, before the layer's fraction is subtracted
    Rgb layer_0;             ///< the layer's Fresnel factor at 0 degrees
    float layer_90 = 0;      ///< the layer's Fresnel factor at 90 degrees
    float taken_0 = 0;       ///< largest fraction of light that the layer takes from the diffuse base, at 0 degrees
    float taken_90 = 0;      ///< the same at 90 degrees
    float width = 1;         ///< GGX's alpha: roughness squared
    bool has_layer = false;  ///< false: diffuse only
};

/// Makes the reflectance from textured values (`base` colour, metallic, roughness) and the material's constants.
[[nodiscard]] Reflectance make_reflectance(const Material& material, Rgb base, float metallic, float roughness);

/// A sampled scattering direction, in the frame whose z is the normal.
struct Scattered {
    Vec3 wi;
    Rgb weight;     ///< BRDF times cosine over pdf
    float pdf = 0;  ///< [1/sr]; 0: absorbed
};

/// BRDF value for a pair of directions, and the density with which `scatter` samples it.
struct Reflected {
    Rgb value;      ///< BRDF [1/sr] times the cosine of wi
    float pdf = 0;  ///< [1/sr]
};

/// Sample and evaluate the same BRDF; directions are in the frame whose z is the normal, wo.z > 0. `choice` in [0, 1)
/// selects the layer or the base.
[[nodiscard]] Scattered scatter(const Reflectance& surface, Vec3 wo, Pair point, float choice);
/// Returns the albedo of the base under the layer for light from wi: the base's part of reflected() is this times
/// cosine / pi.
[[nodiscard]] Rgb base_albedo(const Reflectance& surface, Vec3 wo, Vec3 wi);
[[nodiscard]] Reflected reflect(const Reflectance& surface, Vec3 wo, Vec3 wi);

}  // namespace lobelia
