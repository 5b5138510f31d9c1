// Frames and directions in single precision, for inner loops.
// Duff et al. 2017 (frames).
#pragma once

#include <algorithm>
#include <cmath>

#include "core/sample/sequence.h"
#include "lobelia/math.h"

namespace lobelia {

/// Two axes that make a right-handed frame with the unit vector z: any two, found quickly. They flip where z.z changes
/// its sign; what is stored or averaged stands in tangent_from_world's frame instead.
struct Axes {
    Vec3 x, y, z;
    explicit Axes(Vec3 normal) : z(normal) {
        const float sign = std::copysign(1.0f, normal.z), a = -1.0f / (sign + normal.z), b = normal.x * normal.y * a;
        x = {1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
        y = {b, sign + normal.y * normal.y * a, -normal.y};
    }
    explicit Axes(const Rotation& rows) : x(rows[0]), y(rows[1]), z(rows[2]) {}
    [[nodiscard]] Vec3 world(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
    [[nodiscard]] Vec3 local(Vec3 v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

/// Cosine and sine of 2 pi t for t in [0, 1], within 3e-7.
struct CosSin {
    float cos = 1, sin = 0;
};
[[nodiscard]] inline CosSin cos_sin_turns(float t) {
    // Fold into an eighth of a turn either side of a quarter's multiple, use Taylor's series there.
    const int quarters = (static_cast<int>(8 * t) + 1) / 2;
    const float x = (t - 0.25f * static_cast<float>(quarters)) * static_cast<float>(2 * k_pi), x2 = x * x;
    const float s = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 / 362880))));
    const float c = 1 + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
    switch (quarters & 3) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

/// atan2(s, c) in turns, in [-1/2, 1/2], within 1e-7: a minimax polynomial of the arc tangent's odd powers on [0, 1],
/// good to 4e-8, and reflections.
[[nodiscard]] inline float turns_of(float s, float c) {
    const float across = std::fabs(s), along = std::fabs(c), longer = std::max(across, along);
    const float a = longer > 0 ? std::min(across, along) / longer : 0, a2 = a * a;
    float turns = 0.00108413096f;
    for (const float k : {-0.00534827899f, 0.0126725024f, -0.0210615188f, 0.0315251178f, -0.0530262382f, 0.159154324f})
        turns = turns * a2 + k;
    turns *= a;
    if (across > along) turns = 0.25f - turns;
    if (c < 0) turns = 0.5f - turns;
    return std::copysign(turns, s);
}
/// acos(c) in half turns, for c in [-1, 1], within 2.2e-5: sqrt(1 - |c|) times a minimax polynomial, and a reflection.
[[nodiscard]] inline float rough_half_turns_of(float c) {
    const float x = std::min(std::fabs(c), 1.0f);
    const float t =
        std::sqrt(1 - x) * (0.499978512f + x * (-0.0675183782f + x * (0.0236384388f + x * -0.00596190257f)));
    return c < 0 ? 1 - t : t;
}

/// Directions about z: height a map of point.a, azimuth a turn times point.b.
[[nodiscard]] inline Vec3 around_z(float z, float turn) {
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    const auto [c, s] = cos_sin_turns(turn);
    return {r * c, r * s, z};
}
/// pdf z / pi. Never exactly horizontal.
[[nodiscard]] inline Vec3 cosine_direction(Pair point) {
    const float r = std::sqrt(point.a);
    const auto [c, s] = cos_sin_turns(point.b);
    return {r * c, r * s, std::sqrt(1 - point.a)};
}

}  // namespace lobelia
