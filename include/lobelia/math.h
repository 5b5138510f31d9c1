// Three-component vectors, colours and rotations, and the constants that the rest of the library shares.
#pragma once

#include <array>
#include <cmath>

namespace lobelia {

inline constexpr double k_pi = 3.14159265358979323846;

/// A point of a plane: texture coordinates or texels.
struct Vec2 {
    float x = 0, y = 0;
    friend bool operator==(const Vec2&, const Vec2&) = default;
};

[[nodiscard]] constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
[[nodiscard]] constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
[[nodiscard]] constexpr Vec2 operator*(Vec2 a, float s) { return {a.x * s, a.y * s}; }

/// A point or, where stated, a unit direction; right-handed axes.
struct Vec3 {
    float x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[nodiscard]] constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[nodiscard]] constexpr Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
[[nodiscard]] constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] constexpr Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
/// Returns `a` scaled to length 1. Precondition: `a` is not zero.
[[nodiscard]] inline Vec3 normalize(Vec3 a) { return a * (1.0f / length(a)); }

/// A linear Rec. 709 triple: radiance [W/(m^2 sr)], irradiance [W/m^2] or a coefficient, depending on the context.
struct Rgb {
    float r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb&, const Rgb&) = default;
};

[[nodiscard]] constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
[[nodiscard]] constexpr Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
[[nodiscard]] constexpr Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
/// Returns the relative luminance Y of linear Rec. 709.
[[nodiscard]] constexpr float luminance(Rgb a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

/// A rotation: three orthonormal rows, determinant +1; `rotate(m, v)` is the matrix times the column `v`.
using Rotation = std::array<Vec3, 3>;

[[nodiscard]] constexpr Vec3 rotate(const Rotation& m, Vec3 v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

/// Returns the rotation by `angle` [radians] about the unit `axis`, right-handed (Rodrigues).
[[nodiscard]] inline Rotation rotation_about(Vec3 axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), t = 1 - c;
    const double x = axis.x, y = axis.y, z = axis.z;
    const auto row = [](double a, double b, double d) {
        return Vec3{static_cast<float>(a), static_cast<float>(b), static_cast<float>(d)};
    };
    return {row(c + x * x * t, x * y * t - z * s, x * z * t + y * s),
            row(y * x * t + z * s, c + y * y * t, y * z * t - x * s),
            row(z * x * t - y * s, z * y * t + x * s, c + z * z * t)};
}

}  // namespace lobelia
