// Real spherical harmonics: normalised Legendre recurrences times the powers (x + iy)^m, and their rotation.
#include "core/math/harmonics.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/math/quadrature.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/math/harmonics.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::harmonics::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using lobelia::HWY_NAMESPACE::D;
using lobelia::HWY_NAMESPACE::V;

using lobelia::HWY_NAMESPACE::ColourSum;
using lobelia::HWY_NAMESPACE::DC;
using lobelia::HWY_NAMESPACE::Lanes3;
using lobelia::HWY_NAMESPACE::load;

/// Calls call(i) for i = 0 .. last; where `last` is a constant, so is each i, and all is unrolled.
template <class Call>
HWY_INLINE void for_each_up_to(std::size_t last, const Call& call) {
    for (std::size_t i = 0; i <= last; ++i) call(i);
}
template <std::size_t last, class Call>
HWY_INLINE void for_each_up_to(std::integral_constant<std::size_t, last>, const Call& call) {
    [&]<std::size_t... i>(std::index_sequence<i...>) HWY_ATTR { (call(std::integral_constant<std::size_t, i>()), ...); }
    (std::make_index_sequence<last + 1>());
}

/// Calls `visit(l, i, value)` for the harmonics of the bands l that are `wanted`, at the directions (x, y, z); `table`
/// holds for each order m its first value Q_m^m, then a pair (a, a b) for each l > m, with Q_l = a z Q_{l-1} - a b
/// Q_{l-2}. `degree` is a number, or a constant so that all is unrolled.
template <class Tag, class Degree, class Wanted, class Visit>
HWY_INLINE void for_each_harmonic(Tag d, Degree degree, const float* table, hn::Vec<Tag> x, hn::Vec<Tag> y,
                                  hn::Vec<Tag> z, const Wanted& wanted, const Visit& visit) {
    using Vec = hn::Vec<Tag>;
    Vec cosine = hn::Set(d, 1.0f), sine = hn::Zero(d);
    for_each_up_to(degree, [&](auto m) HWY_ATTR {
        Vec q = hn::Set(d, *table++), previous = hn::Zero(d);
        for (std::size_t l = m; l <= degree; ++l) {
            if (wanted(l)) {
                visit(l, l * l + l + m, hn::Mul(q, cosine));
                if (m > 0) visit(l, l * l + l - m, hn::Mul(q, sine));
            }
            if (l == degree) break;
            const Vec next =
                hn::NegMulAdd(hn::Set(d, table[1]), previous, hn::Mul(hn::Mul(hn::Set(d, table[0]), z), q));
            table += 2;
            previous = q;
            q = next;
        }
        // Step to (x + iy)^(m + 1).
        const Vec turned = hn::NegMulAdd(y, sine, hn::Mul(x, cosine));
        sine = hn::MulAdd(x, sine, hn::Mul(y, cosine));
        cosine = turned;
    });
}

constexpr auto k_every_band = [](std::size_t) { return true; };

void Values(std::size_t degree, const float* table, DirectionView block, float* rows) {
    const D d;
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const Lanes3 w = load(d, block, j);
        for_each_harmonic(d, degree, table, w.x, w.y, w.z, k_every_band,
                          [&](std::size_t, std::size_t i, V value)
                              HWY_ATTR { hn::StoreU(value, d, rows + i * k_block_size + j); });
    }
}

template <class Degree, class Wanted>
void sum(Degree degree, const Wanted& wanted, const float* table, const Rgb* c, DirectionView directions,
         MutableColourView out) {
    const D d;
    for (std::size_t j = 0; j < directions.size; j += hn::Lanes(d)) {
        V r = hn::Zero(d), g = r, b = r;
        const Lanes3 w = load(d, directions, j);
        const auto add = [&](std::size_t, std::size_t i, V value) HWY_ATTR {
            r = hn::MulAdd(hn::Set(d, c[i].r), value, r);
            g = hn::MulAdd(hn::Set(d, c[i].g), value, g);
            b = hn::MulAdd(hn::Set(d, c[i].b), value, b);
        };
        for_each_harmonic(d, degree, table, w.x, w.y, w.z, wanted, add);
        lobelia::HWY_NAMESPACE::store(d, r, out.channel(0), j, out.size);
        lobelia::HWY_NAMESPACE::store(d, g, out.channel(1), j, out.size);
        lobelia::HWY_NAMESPACE::store(d, b, out.channel(2), j, out.size);
    }
}

template <std::size_t degree>
void sum_unrolled(const float* table, const Rgb* c, DirectionView directions, MutableColourView out) {
    sum(std::integral_constant<std::size_t, degree>(), k_every_band, table, c, directions, out);
}

void Sum(std::size_t degree, const float* table, const Rgb* c, DirectionView directions, MutableColourView out) {
    switch (degree) {
        case 1:
            return sum_unrolled<1>(table, c, directions, out);
        case 2:
            return sum_unrolled<2>(table, c, directions, out);
        case 3:
            return sum_unrolled<3>(table, c, directions, out);
        case 4:
            return sum_unrolled<4>(table, c, directions, out);
        default:
            break;
    }
    // Irradiance has no odd bands beyond the first: leave out bands of zeros.
    std::uint64_t lit = 0;
    for (std::size_t l = 0; l <= degree; ++l)
        if (l >= 64 || std::any_of(c + l * l, c + (l + 1) * (l + 1), [](Rgb v) { return v != Rgb{}; }))
            lit |= std::uint64_t{1} << std::min<std::size_t>(l, 63);
    sum(
        degree, [&](std::size_t l) { return (lit >> std::min<std::size_t>(l, 63) & 1) != 0; }, table, c, directions,
        out);
}

/// Evaluates one direction, with red, green and blue in the lanes of a vector.
template <class Degree, class Wanted>
HWY_INLINE Rgb sum_at(Degree degree, const Wanted& wanted, const float* table, const Rgb* c, const float* factors,
                      const Vec3& w) {
    const DC d;
    ColourSum sum(c, (degree + 1) * (degree + 1));
    for_each_harmonic(d, degree, table, hn::Set(d, w.x), hn::Set(d, w.y), hn::Set(d, w.z), wanted,
                      [&](std::size_t l, std::size_t i, hn::Vec<DC> value)
                          HWY_ATTR { sum.add(i, hn::Mul(value, hn::Set(d, factors[l]))); });
    return sum.total();
}
template <std::size_t degree>
Rgb sum_at_unrolled(const float* table, const Rgb* c, const float* factors, const Vec3& w) {
    return sum_at(std::integral_constant<std::size_t, degree>(), k_every_band, table, c, factors, w);
}

/// Degree 2 as polynomials of x, y and z, which wait for each other less than recurrences do.
Rgb sum_at_degree_2(const Rgb* c, const float* factors, const Vec3& w) {
    constexpr float y_0 = 0.28209479f, y_1 = 0.48860251f;  // sqrt(1 / 4 pi), sqrt(3 / 4 pi)
    // sqrt(15 / 4 pi) for xy, yz, xz; sqrt(5 / 16 pi) for 3 z^2 - 1; sqrt(15 / 16 pi) for x^2 - y^2.
    constexpr float y_2 = 1.09254843f, y_20 = 0.31539157f, y_22 = 0.54627422f;
    const DC d;
    ColourSum sum(c, 9);
    const float one = y_1 * factors[1], two = y_2 * factors[2];
    const float x = two * w.x, y = two * w.y;
    sum.add(0, hn::Set(d, y_0 * factors[0]));
    sum.add(1, hn::Set(d, one * w.y));
    sum.add(2, hn::Set(d, one * w.z));
    sum.add(3, hn::Set(d, one * w.x));
    sum.add(4, hn::Set(d, x * w.y));
    sum.add(5, hn::Set(d, y * w.z));
    sum.add(6, hn::Set(d, y_20 * factors[2] * (3 * w.z * w.z - 1)));
    sum.add(7, hn::Set(d, x * w.z));
    sum.add(8, hn::Set(d, y_22 * factors[2] * (w.x * w.x - w.y * w.y)));
    return sum.total();
}

Rgb SumAt(std::size_t degree, const float* table, const Rgb* c, const float* factors, const Vec3& w) {
    switch (degree) {
        case 1:
            return sum_at_unrolled<1>(table, c, factors, w);
        case 2:
            return sum_at_degree_2(c, factors, w);
        case 3:
            return sum_at_unrolled<3>(table, c, factors, w);
        default:
            // Leave out the bands that irradiance does not have.
            return sum_at(
                degree, [&](std::size_t l) { return factors[l] != 0; }, table, c, factors, w);
    }
}

void ValuesAt(std::size_t degree, const float* table, const Vec3& w, float* values) {
    const hn::CappedTag<float, 1> d;
    for_each_harmonic(d, degree, table, hn::Set(d, w.x), hn::Set(d, w.y), hn::Set(d, w.z), k_every_band,
                      [&](std::size_t, std::size_t i, hn::Vec<hn::CappedTag<float, 1>> value)
                          HWY_ATTR { values[i] = hn::GetLane(value); });
}

}  // namespace lobelia::harmonics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::harmonics {

HWY_EXPORT(Values);
HWY_EXPORT(Sum);
HWY_EXPORT(SumAt);
HWY_EXPORT(ValuesAt);

double clamped_cosine(std::size_t l) {
    if (l == 0) return k_pi;
    if (l == 1) return 2 * k_pi / 3;
    if (l % 2 == 1) return 0;
    // 2 pi (-1)^(l/2 - 1) l! / ((l + 2) (l - 1) 2^l ((l/2)!)^2); the binomial part is a running product.
    double binomial = 1;
    for (std::size_t k = 1; k <= l / 2; ++k) binomial *= static_cast<double>(2 * k - 1) / static_cast<double>(2 * k);
    const double sign = (l / 2) % 2 == 1 ? 1 : -1;
    return sign * 2 * k_pi * binomial / static_cast<double>((l + 2) * (l - 1));
}

Harmonics::Harmonics(std::size_t degree) : degree_(degree) {
    double first = std::sqrt(1 / (4 * k_pi));
    for (std::size_t m = 0; m <= degree; ++m) {
        // Q_m^m = sqrt(2) sqrt((2m + 1) / (4 pi (2m)!)) (2m - 1)!!, from one order to the next.
        if (m > 0)
            first *= std::sqrt((m == 1 ? 2.0 : 1.0) * static_cast<double>(2 * m + 1) / static_cast<double>(2 * m));
        table_.push_back(static_cast<float>(first));
        const auto mm = static_cast<double>(m * m);
        for (std::size_t l = m + 1; l <= degree; ++l) {
            const auto ll = static_cast<double>(l * l), below = static_cast<double>((l - 1) * (l - 1));
            const double a = std::sqrt((4 * ll - 1) / (ll - mm));
            const double b = std::sqrt(std::max(0.0, below - mm) / (4 * below - 1 > 0 ? 4 * below - 1 : 1));
            table_.push_back(static_cast<float>(a));
            table_.push_back(static_cast<float>(a * b));
        }
    }
}

void Harmonics::values(DirectionView block, float* rows) const {
    HWY_DYNAMIC_DISPATCH(Values)(degree_, table_.data(), block, rows);
}

void Harmonics::sum(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    check_equal("coefficients", c.size(), size());
    check_equal("colours for the directions", out.size, directions.size);
    HWY_DYNAMIC_DISPATCH(Sum)(degree_, table_.data(), c.data(), directions, out);
}

void Harmonics::values_at(Vec3 direction, float* values) const {
    HWY_DYNAMIC_DISPATCH(ValuesAt)(degree_, table_.data(), direction, values);
}

Rgb Harmonics::sum_at(std::span<const Rgb> c, std::span<const float> band_factors, Vec3 direction) const {
    check_equal("coefficients", c.size(), size());
    check_equal("factors of bands", band_factors.size(), degree_ + 1);
    return HWY_DYNAMIC_DISPATCH(SumAt)(degree_, table_.data(), c.data(), band_factors.data(), direction);
}

std::vector<double> values(std::size_t degree, double x, double y, double z) {
    const double cosine = std::clamp(z / std::hypot(x, y, z), -1.0, 1.0), phi = std::atan2(y, x);
    std::vector<double> result(coefficient_count(degree));
    for (std::size_t l = 0; l <= degree; ++l)
        for (std::size_t m = 0; m <= l; ++m) {
            // std::sph_legendre would write to the global signgam, by way of lgamma: a race between threads.
            double norm = static_cast<double>(2 * l + 1) / (4 * k_pi) * (m > 0 ? 2 : 1);
            for (std::size_t k = l - m + 1; k <= l + m; ++k) norm /= static_cast<double>(k);
            const double legendre =
                std::sqrt(norm) * std::assoc_legendre(static_cast<unsigned>(l), static_cast<unsigned>(m), cosine);
            result[l * l + l + m] = legendre * std::cos(static_cast<double>(m) * phi);
            if (m > 0) result[l * l + l - m] = legendre * std::sin(static_cast<double>(m) * phi);
        }
    return result;
}

Matrix rotation_matrix(const Rotation& r, std::size_t l) {
    // R_ij = integral of Y_i(R w) Y_j(w): a polynomial of degree 2l, so that l + 1 heights are exact.
    const std::size_t size = 2 * l + 1, first = l * l;
    const GaussLegendre heights(l + 1);
    const std::size_t azimuths = 2 * l + 1;
    Matrix matrix(size * size);
    for (std::size_t h = 0; h < heights.nodes.size(); ++h)
        for (std::size_t a = 0; a < azimuths; ++a) {
            const double z = heights.nodes[h], s = std::sqrt(1 - z * z);
            const double phi = 2 * k_pi * static_cast<double>(a) / static_cast<double>(azimuths);
            const double x = s * std::cos(phi), y = s * std::sin(phi);
            const auto row = [&](const Vec3& v) { return v.x * x + v.y * y + v.z * z; };
            const auto from = values(l, x, y, z), to = values(l, row(r[0]), row(r[1]), row(r[2]));
            const double weight = heights.weights[h] * 2 * k_pi / static_cast<double>(azimuths);
            for (std::size_t i = 0; i < size; ++i)
                for (std::size_t j = 0; j < size; ++j) matrix[i * size + j] += weight * to[first + i] * from[first + j];
        }
    return matrix;
}

namespace {

void rotate_degree_1(const Rotation& r, std::span<const Rgb> c, std::span<Rgb> out) {
    // Y_1 = sqrt(3 / 4 pi) (y, z, x).
    const auto turn = [&](auto channel) { return rotate(r, Vec3{channel(c[2]), channel(c[0]), channel(c[1])}); };
    const Vec3 red = turn([](Rgb v) { return v.r; }), green = turn([](Rgb v) { return v.g; }),
               blue = turn([](Rgb v) { return v.b; });
    out[0] = {red.y, green.y, blue.y};
    out[1] = {red.z, green.z, blue.z};
    out[2] = {red.x, green.x, blue.x};
}

/// Band 2 of one channel as the traceless symmetric M of L_2(w) = w^T M w, turned to R M R^T.
std::array<double, 5> rotate_quadratic_form(const Rotation& r, const std::array<double, 5>& c) {
    const double k = std::sqrt(15 / (4 * k_pi)), q = std::sqrt(5 / (16 * k_pi));
    const double xy = k * c[0] / 2, yz = k * c[1] / 2, xz = k * c[3] / 2;
    const double m[3][3] = {
        {-q * c[2] + k * c[4] / 2, xy, xz}, {xy, -q * c[2] - k * c[4] / 2, yz}, {xz, yz, 2 * q * c[2]}};
    const auto form = [&](Vec3 a, Vec3 b) {
        const double u[3] = {a.x, a.y, a.z}, v[3] = {b.x, b.y, b.z};
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) sum += u[i] * m[i][j] * v[j];
        return sum;
    };
    return {2 * form(r[0], r[1]) / k, 2 * form(r[1], r[2]) / k, form(r[2], r[2]) / (2 * q), 2 * form(r[0], r[2]) / k,
            (form(r[0], r[0]) - form(r[1], r[1])) / k};
}

void rotate_degree_2(const Rotation& r, std::span<const Rgb> c, std::span<Rgb> out) {
    std::array<double, 5> red{}, green{}, blue{};
    for (std::size_t i = 0; i < 5; ++i) {
        red[i] = c[i].r;
        green[i] = c[i].g;
        blue[i] = c[i].b;
    }
    red = rotate_quadratic_form(r, red);
    green = rotate_quadratic_form(r, green);
    blue = rotate_quadratic_form(r, blue);
    for (std::size_t i = 0; i < 5; ++i)
        out[i] = {static_cast<float>(red[i]), static_cast<float>(green[i]), static_cast<float>(blue[i])};
}

}  // namespace

std::vector<Rgb> rotated(const Rotation& r, std::span<const Rgb> c) {
    std::vector<Rgb> result(c.size());
    const auto bands = static_cast<std::size_t>(std::sqrt(static_cast<double>(c.size())));
    check_equal("coefficients of whole bands", c.size(), bands * bands);
    for (std::size_t l = 0; l < bands; ++l) {
        const std::size_t size = 2 * l + 1;
        const auto from = c.subspan(l * l, size);
        const auto to = std::span(result).subspan(l * l, size);
        if (l == 0) {
            to[0] = from[0];
        } else if (l == 1) {
            rotate_degree_1(r, from, to);
        } else if (l == 2) {
            rotate_degree_2(r, from, to);
        } else {
            const Matrix matrix = rotation_matrix(r, l);
            for (std::size_t i = 0; i < size; ++i)
                for (std::size_t j = 0; j < size; ++j)
                    to[i] = to[i] + from[j] * static_cast<float>(matrix[i * size + j]);
        }
    }
    return result;
}

}  // namespace lobelia::harmonics
#endif
