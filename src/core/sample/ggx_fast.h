// GGX in single precision, for the inner loops of the path tracer. ggx.h has the same in double precision, with pdfs
// and inverses; a test holds the two to each other. `width` is alpha; directions are in the frame of the normal. Walter
// et al. 2007; Heitz 2018 (visible normals).
#pragma once

#include "core/sample/directions.h"

namespace lobelia::ggx::fast {

/// GGX's distribution of normals; from the sine, so that it keeps its digits for narrow lobes.
[[nodiscard]] inline float distribution(float width, Vec3 h) {
    const float w2 = width * width, d = w2 * h.z * h.z + h.x * h.x + h.y * h.y;
    return w2 / (static_cast<float>(k_pi) * d * d);
}
/// Smith's Lambda of a direction, v.z > 0.
[[nodiscard]] inline float lambda(float width, Vec3 v) {
    const float tan2 = (v.x * v.x + v.y * v.y) / (v.z * v.z);
    return 0.5f * (std::sqrt(1 + width * width * tan2) - 1);
}

/// A normal visible from wo (Heitz 2018): stretch, sample the projected hemisphere, unstretch.
[[nodiscard]] inline Vec3 visible_normal(float width, Vec3 wo, Pair point) {
    const Vec3 stretched = normalize(Vec3{width * wo.x, width * wo.y, wo.z});
    const float flat = stretched.x * stretched.x + stretched.y * stretched.y;
    const Vec3 t1 = flat > 0 ? Vec3{-stretched.y, stretched.x, 0} * (1 / std::sqrt(flat)) : Vec3{1, 0, 0};
    const Vec3 t2 = cross(stretched, t1);
    const float r = std::sqrt(point.a), s = 0.5f * (1 + stretched.z);
    const auto [c, sn] = cos_sin_turns(point.b);
    const float p1 = r * c, p2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - p1 * p1)) + s * r * sn;
    const Vec3 h = t1 * p1 + t2 * p2 + stretched * std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2));
    return normalize(Vec3{width * h.x, width * h.y, std::max(1e-6f, h.z)});
}

}  // namespace lobelia::ggx::fast
