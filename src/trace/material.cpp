// Diffuse and GGX reflection.
#include "trace/material.h"

#include <cmath>

#include "core/sample/ggx_fast.h"
#include "lobelia/planes.h"

namespace lobelia {
namespace {

using ggx::fast::distribution;
using ggx::fast::lambda;
using ggx::fast::visible_normal;

/// Minimum GGX width: smoother surfaces use it, because light sampling needs a highlight of finite width.
constexpr float k_least_width = 1e-3f;

/// Schlick's blend from 0 (along the half vector) to 1 (at 90 degrees).
float schlick(float cosine) {
    const float m = std::clamp(1 - cosine, 0.0f, 1.0f), m2 = m * m;
    return m2 * m2 * m;
}

Rgb layer_fresnel(const Reflectance& s, float cosine) {
    const float k = schlick(cosine);
    return s.layer_0 * (1 - k) + Rgb{k, k, k} * s.layer_90;
}
/// Fraction of light that the layer transmits to the base.
float left(const Reflectance& s, float cosine) {
    const float k = schlick(cosine);
    return 1 - (s.taken_0 * (1 - k) + s.taken_90 * k);
}

/// Returns the probability of choosing the layer: its fraction of the light at this angle, clamped to [0.1, 0.9].
float layer_share(const Reflectance& s, Vec3 wo) {
    if (!s.has_layer) return 0;
    if (is_black(s.diffuse)) return 1;
    const float layer = largest(layer_fresnel(s, wo.z)), base = largest(s.diffuse) * left(s, wo.z);
    return std::clamp(layer / (layer + base), 0.1f, 0.9f);
}

}  // namespace

Reflectance make_reflectance(const Material& material, Rgb base, float metallic, float roughness) {
    if (material.unlit) return {};
    const float ratio = (material.ior - 1) / (material.ior + 1), normal = ratio * ratio;
    const auto dielectric = [&](float tint) { return std::min(normal * tint, 1.0f) * material.specular; };
    const Rgb coat{dielectric(material.specular_color.r), dielectric(material.specular_color.g),
                   dielectric(material.specular_color.b)};
    Reflectance s;
    s.diffuse = base * (1 - metallic);
    s.layer_0 = base * metallic + coat * (1 - metallic);
    s.layer_90 = metallic + material.specular * (1 - metallic);
    s.taken_0 = largest(coat);
    s.taken_90 = material.specular;
    s.width = std::max(k_least_width, roughness * roughness);
    s.has_layer = !is_black(s.layer_0) || s.layer_90 > 0;
    return s;
}

Rgb base_albedo(const Reflectance& s, Vec3 wo, Vec3 wi) {
    return s.has_layer ? s.diffuse * left(s, dot(wi, normalize(wo + wi))) : s.diffuse;
}

Reflected reflect(const Reflectance& s, Vec3 wo, Vec3 wi) {
    if (wi.z <= 0 || wo.z <= 0) return {};
    const float base = wi.z * k_over_pi;
    if (!s.has_layer) return {s.diffuse * base, base};
    // Evaluate the layer: D G F / (4 cos cos), times the cosine of wi; visible normals have the density D / (4 cos (1 +
    // Lambda)).
    const Vec3 h = normalize(wo + wi);
    const float cosine = dot(wi, h), seen = 1 + lambda(s.width, wo);
    const float d = distribution(s.width, h) / (4 * wo.z), share = layer_share(s, wo);
    const Rgb value =
        s.diffuse * (left(s, cosine) * base) + layer_fresnel(s, cosine) * (d / (seen + lambda(s.width, wi)));
    return {value, share * d / seen + (1 - share) * base};
}

Scattered scatter(const Reflectance& s, Vec3 wo, Pair point, float choice) {
    if (!s.has_layer) {
        const Vec3 wi = cosine_direction(point);
        return {wi, s.diffuse, wi.z * k_over_pi};
    }
    Vec3 wi;
    if (choice < layer_share(s, wo)) {
        const Vec3 h = visible_normal(s.width, wo, point);
        wi = h * (2 * dot(wo, h)) - wo;
    } else {
        wi = cosine_direction(point);
    }
    const auto [value, pdf] = reflect(s, wo, wi);
    if (!(pdf > 0)) return {};
    return {wi, value * (1 / pdf), pdf};
}

}  // namespace lobelia
