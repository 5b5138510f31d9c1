// Shared by tests: sample sets from functions of a direction, real environments, distances, random input.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/math/quadrature.h"
#include "lobelia/basis.h"
#include "lobelia/environment.h"
#include "lobelia/sampling.h"
#include "lobelia/sky.h"

namespace lobelia::test {

/// A rotation in general position.
inline Rotation some_rotation() { return rotation_about(normalize(Vec3{0.3f, -0.8f, 0.5f}), 1.1); }
inline Rotation about_z(double angle) { return rotation_about({0, 0, 1}, angle); }

inline Directions random_directions(Domain domain, std::size_t count, std::uint32_t seed) {
    return uniform_directions(domain, Sequence::random, count, seed);
}

/// Samples radiance(direction) at well-spread, shuffled directions with equal shares.
template <class Radiance>
Samples samples_of(Domain domain, std::size_t count, const Radiance& radiance, Sequence sequence = Sequence::sobol) {
    const Directions directions = uniform_directions(domain, sequence, count, 7);
    const auto share = static_cast<float>(solid_angle(domain) / static_cast<double>(count));
    Samples samples(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 d = direction_at(directions, i);
        samples.set(i, {d, radiance(d), share});
    }
    std::mt19937 generator(11);
    return reordered(samples, shuffled_order(count, generator));
}

/// Returns entries [begin, end) as samples; unlike part(), from any entry on.
inline Samples slice(const Samples& samples, std::size_t begin, std::size_t end) {
    Samples result(end - begin);
    for (std::size_t i = begin; i < end; ++i) result.set(i - begin, samples[i]);
    return result;
}

/// Returns the same samples with rotated directions.
inline Samples turned(const Samples& samples, const Rotation& r) {
    Samples result(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        RadianceSample s = samples[i];
        s.direction = rotate(r, s.direction);
        result.set(i, s);
    }
    return result;
}
inline Directions turned(const Directions& directions, const Rotation& r) {
    Directions result(directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i)
        set_entry(result.view(), i, rotate(r, direction_at(directions, i)));
    return result;
}

/// The default sky with its sun, small: a high dynamic range, and dark below.
inline Image small_sky() { return sky({64, 32}); }

/// Returns every texel once, shuffled.
inline Samples shuffled_texels(const Image& image, Domain domain, std::uint32_t seed) {
    const Samples texels = texel_samples(image, domain);
    std::mt19937 generator(seed);
    return reordered(texels, shuffled_order(texels.size(), generator));
}

inline double norm(Rgb c) {
    return std::sqrt(static_cast<double>(c.r) * c.r + static_cast<double>(c.g) * c.g + static_cast<double>(c.b) * c.b);
}
inline double norm(const std::vector<Rgb>& c) {
    double sum = 0;
    for (const Rgb& v : c) sum += norm(v) * norm(v);
    return std::sqrt(sum);
}
/// |a - b|, over all channels and entries.
inline double distance(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    std::vector<Rgb> d(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
    return norm(d);
}
/// |a - b|_G / |b|_G: the error of radiance over the domain, G the exact Gram matrix of the basis.
inline double excess(const LinearBasis& basis, const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    const Matrix gram = basis.gram();
    const auto squared = [&](const std::vector<Rgb>& v) {
        double sum = 0;
        for (std::size_t i = 0; i < v.size(); ++i)
            for (std::size_t j = 0; j < v.size(); ++j)
                sum += gram[i * v.size() + j] *
                       (static_cast<double>(v[i].r) * v[j].r + static_cast<double>(v[i].g) * v[j].g +
                        static_cast<double>(v[i].b) * v[j].b);
        return sum;
    };
    std::vector<Rgb> difference(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) difference[i] = a[i] - b[i];
    return std::sqrt(std::max(0.0, squared(difference)) / squared(b));
}
inline double largest_difference(ColourView a, ColourView b) {
    double largest = a.size == b.size ? 0 : HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < a.size && i < b.size; ++i) {
            const double d = std::abs(static_cast<double>(a.channel(k)[i]) - b.channel(k)[i]);
            largest = d <= largest ? largest : d;  // NaN counts as large
        }
    return largest;
}
inline double largest(ColourView a) { return largest_difference(a, Colours(a.size)); }
inline bool all_finite(const std::vector<Rgb>& c) {
    return std::all_of(c.begin(), c.end(), [](Rgb v) { return std::isfinite(v.r + v.g + v.b); });
}
inline bool all_finite(ColourView a) {
    for (std::size_t k = 0; k < 3; ++k)
        if (!std::all_of(a.channel(k), a.channel(k) + a.size, [](float v) { return std::isfinite(v); })) return false;
    return true;
}
/// Colours uniform in [-1, 1) per channel.
inline std::vector<Rgb> random_colours(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-31f - 1; };
    std::vector<Rgb> c(count);
    for (Rgb& v : c) v = {uniform(), uniform(), uniform()};
    return c;
}
/// A rotation that takes +z to the unit vector `n`.
inline Rotation rotation_to(Vec3 n) {
    const Vec3 t = normalize(cross(std::abs(n.x) < 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n)), b = cross(n, t);
    return {Vec3{t.x, b.x, n.x}, Vec3{t.y, b.y, n.y}, Vec3{t.z, b.z, n.z}};
}
inline float least(ColourView a) {
    float result = INFINITY;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < a.size; ++i) result = std::min(result, a.channel(k)[i]);
    return result;
}

/// Returns the value that chi-square of `freedom` degrees exceeds with probability 1e-4 (Wilson and Hilferty 1931,
/// accurate to 1 % from 10 degrees on): 3.719 is the normal quantile.
inline double chi_square_limit(std::size_t freedom) {
    const double v = 2.0 / (9.0 * static_cast<double>(freedom));
    return static_cast<double>(freedom) * std::pow(1 - v + 3.719 * std::sqrt(v), 3);
}

}  // namespace lobelia::test
