// Vectors and functions of shader languages in C++, so that tests can compile and run the emitted MSL as C++.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shader_types {

template <std::size_t N>
struct Vec;
template <>
struct Vec<2> {
    float x, y;
    Vec() = default;
    explicit Vec(float s) : x(s), y(s) {}
    Vec(float a, float b) : x(a), y(b) {}
    float& operator[](std::size_t i) { return i == 0 ? x : y; }
    float operator[](std::size_t i) const { return i == 0 ? x : y; }
};
template <>
struct Vec<3> {
    float x, y, z;
    Vec() = default;
    explicit Vec(float s) : x(s), y(s), z(s) {}
    Vec(float a, float b, float c) : x(a), y(b), z(c) {}
    float& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
    float operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
};
template <>
struct Vec<4> {
    float x, y, z, w;
    Vec() = default;
    explicit Vec(float s) : x(s), y(s), z(s), w(s) {}
    Vec(float a, float b, float c, float d) : x(a), y(b), z(c), w(d) {}
    float& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
    float operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};

// With constant indices, not in a loop: even -O1 then keeps vectors in registers.
template <std::size_t N, class F>
Vec<N> each(const F& f) {
    if constexpr (N == 2) return {f(0), f(1)};
    if constexpr (N == 3) return {f(0), f(1), f(2)};
    if constexpr (N == 4) return {f(0), f(1), f(2), f(3)};
}

#define SHADER_INLINE [[gnu::always_inline]] inline
#define SHADER_OPERATOR(op)                                                                                           \
    SHADER_INLINE Vec<2> operator op(Vec<2> a, Vec<2> b) { return {a.x op b.x, a.y op b.y}; }                         \
    SHADER_INLINE Vec<2> operator op(Vec<2> a, float b) { return {a.x op b, a.y op b}; }                              \
    SHADER_INLINE Vec<2> operator op(float a, Vec<2> b) { return {a op b.x, a op b.y}; }                              \
    SHADER_INLINE Vec<3> operator op(Vec<3> a, Vec<3> b) { return {a.x op b.x, a.y op b.y, a.z op b.z}; }             \
    SHADER_INLINE Vec<3> operator op(Vec<3> a, float b) { return {a.x op b, a.y op b, a.z op b}; }                    \
    SHADER_INLINE Vec<3> operator op(float a, Vec<3> b) { return {a op b.x, a op b.y, a op b.z}; }                    \
    SHADER_INLINE Vec<4> operator op(Vec<4> a, Vec<4> b) { return {a.x op b.x, a.y op b.y, a.z op b.z, a.w op b.w}; } \
    SHADER_INLINE Vec<4> operator op(Vec<4> a, float b) { return {a.x op b, a.y op b, a.z op b, a.w op b}; }          \
    SHADER_INLINE Vec<4> operator op(float a, Vec<4> b) { return {a op b.x, a op b.y, a op b.z, a op b.w}; }          \
    template <std::size_t N, class B>                                                                                 \
    SHADER_INLINE Vec<N>& operator op##=(Vec<N>& a, B b) {                                                            \
        return a = a op b;                                                                                            \
    }
SHADER_OPERATOR(+)
SHADER_OPERATOR(-)
SHADER_OPERATOR(*)
SHADER_OPERATOR(/)
#undef SHADER_OPERATOR
template <std::size_t N>
Vec<N> operator-(Vec<N> a) {
    return each<N>([&](std::size_t i) { return -a[i]; });
}

template <std::size_t N>
SHADER_INLINE float dot(Vec<N> a, Vec<N> b) {
    if constexpr (N == 3) return a.x * b.x + a.y * b.y + a.z * b.z;
    float sum = 0;
    for (std::size_t i = 0; i < N; ++i) sum += a[i] * b[i];
    return sum;
}
template <std::size_t N>
float length(Vec<N> a) {
    return std::sqrt(dot(a, a));
}
template <std::size_t N>
Vec<N> normalize(Vec<N> a) {
    return a / length(a);
}
inline Vec<3> cross(Vec<3> a, Vec<3> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline float sign(float x) { return x > 0 ? 1.0f : x < 0 ? -1.0f : 0.0f; }
inline float rsqrt(float x) { return 1 / std::sqrt(x); }
inline float inversesqrt(float x) { return rsqrt(x); }
inline float atan(float y, float x) { return std::atan2(y, x); }
using std::atan2;
inline float min(float a, float b) { return std::min(a, b); }
inline float max(float a, float b) { return std::max(a, b); }
inline float clamp(float x, float a, float b) { return std::min(std::max(x, a), b); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }
template <class T>
T choose(bool condition, T a, T b) {
    return condition ? a : b;
}
template <class T>
T select(T b, T a, bool condition) {
    return condition ? a : b;
}

#define SHADER_FUNCTION(name)                                           \
    inline float name(float x) { return std::name(x); }                 \
    template <std::size_t N>                                            \
    Vec<N> name(Vec<N> a) {                                             \
        return each<N>([&](std::size_t i) { return std::name(a[i]); }); \
    }
SHADER_FUNCTION(exp)
SHADER_FUNCTION(exp2)
SHADER_FUNCTION(log)
SHADER_FUNCTION(log2)
SHADER_FUNCTION(sqrt)
SHADER_FUNCTION(sin)
SHADER_FUNCTION(cos)
SHADER_FUNCTION(acos)
SHADER_FUNCTION(floor)
#undef SHADER_FUNCTION
inline float abs(float x) { return std::abs(x); }
inline float pow(float x, float y) { return std::pow(x, y); }
#define SHADER_FUNCTION(name, parameters, arguments)                            \
    template <std::size_t N>                                                    \
    Vec<N> name parameters {                                                    \
        return each<N>([&](std::size_t i) -> float { return name arguments; }); \
    }
SHADER_FUNCTION(abs, (Vec<N> a), (a[i]))
SHADER_FUNCTION(sign, (Vec<N> a), (a[i]))
SHADER_FUNCTION(inversesqrt, (Vec<N> a), (a[i]))
SHADER_FUNCTION(rsqrt, (Vec<N> a), (a[i]))
SHADER_FUNCTION(pow, (Vec<N> a, Vec<N> b), (a[i], b[i]))
SHADER_FUNCTION(min, (Vec<N> a, Vec<N> b), (a[i], b[i]))
SHADER_FUNCTION(max, (Vec<N> a, Vec<N> b), (a[i], b[i]))
SHADER_FUNCTION(clamp, (Vec<N> x, Vec<N> a, Vec<N> b), (x[i], a[i], b[i]))
SHADER_FUNCTION(mix, (Vec<N> a, Vec<N> b, Vec<N> t), (a[i], b[i], t[i]))
#undef SHADER_FUNCTION

using vec2 = Vec<2>;
using vec3 = Vec<3>;
using vec4 = Vec<4>;
// The names of Metal.
using float2 = Vec<2>;
using float3 = Vec<3>;
using float4 = Vec<4>;

}  // namespace shader_types
