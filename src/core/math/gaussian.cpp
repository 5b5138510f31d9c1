// Single spherical Gaussians in double precision: closed forms, Bessel ratios, quadratures.
#include "core/math/gaussian.h"

#include <algorithm>

#include "core/math/harmonics.h"
#include "core/math/quadrature.h"

namespace lobelia::gaussian {
namespace {

/// The vector l1 p1 + l2 p2 and what the product of two lobes needs of it.
struct Sum {
    double x, y, z, length, log_amplitude;
};

Sum sum_of(const Lobe& a, const Lobe& b) {
    const double l1 = a.sharpness, l2 = b.sharpness;
    Sum s{};
    s.x = l1 * a.axis.x + l2 * b.axis.x;
    s.y = l1 * a.axis.y + l2 * b.axis.y;
    s.z = l1 * a.axis.z + l2 * b.axis.z;
    s.length = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
    // |u| - l1 - l2 without its cancellation.
    const double dx = a.axis.x - b.axis.x, dy = a.axis.y - b.axis.y, dz = a.axis.z - b.axis.z;
    const double total = s.length + l1 + l2;
    s.log_amplitude = total > 0 ? -l1 * l2 * (dx * dx + dy * dy + dz * dz) / total : 0;
    return s;
}

/// e^-x I_n(x), x >= 0: the library's series, then Hankel's asymptotic one where that would overflow.
double scaled_bessel_i(int n, double x) {
    if (x < 40) return std::exp(-x) * std::cyl_bessel_i(static_cast<double>(n), x);
    double term = 1, sum = 1;
    for (int k = 1; k < 16; ++k) {
        term *= ((2.0 * k - 1) * (2.0 * k - 1) - 4.0 * n * n) / (8.0 * k * x);
        sum += term;
    }
    return sum / std::sqrt(2 * k_pi * x);
}

/// Integral over the hemisphere z >= 0 of the lobe times `weight(cos alpha)`, alpha the angle from z: the azimuth gives
/// a Bessel function, the rest is smooth and peaks at the lobe's own angle with width 1 / sqrt(lambda).
template <class Weight>
double hemisphere_quadrature(double sharpness, double cosine, const Weight& weight) {
    const double beta = std::acos(std::clamp(cosine, -1.0, 1.0));
    // Beyond 12 widths the lobe is below e^-46 of its peak even in the chord's measure.
    const double reach = std::min(k_pi, 12 / std::sqrt(std::max(sharpness, 1e-9)));
    const double low = std::max(0.0, beta - reach), high = std::min(k_pi / 2, beta + reach);
    if (low >= high) return 0;
    static const GaussLegendre rule(24);
    constexpr int panels = 8;
    double sum = 0;
    for (int p = 0; p < panels; ++p) {
        const double half = (high - low) / (2 * panels), centre = low + (2 * p + 1) * half;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double alpha = centre + half * rule.nodes[i];
            const double chord = std::sin((alpha - beta) / 2);
            const double lobe = std::exp(-2 * sharpness * chord * chord) *
                                scaled_bessel_i(0, sharpness * std::sin(alpha) * std::sin(beta));
            sum += half * rule.weights[i] * lobe * std::sin(alpha) * weight(std::cos(alpha));
        }
    }
    return 2 * k_pi * sum;
}

}  // namespace

double integral(double sharpness) {
    if (sharpness < 1e-12) return 4 * k_pi;
    return 4 * k_pi * std::expm1(-2 * sharpness) / (-2 * sharpness);
}

ScaledLobe product(const Lobe& a, const Lobe& b) {
    const Sum s = sum_of(a, b);
    if (s.length <= 0) return {{a.axis, 0}, std::exp(s.log_amplitude)};
    const Vec3 axis{static_cast<float>(s.x / s.length), static_cast<float>(s.y / s.length),
                    static_cast<float>(s.z / s.length)};
    return {{axis, static_cast<float>(s.length)}, std::exp(s.log_amplitude)};
}

double inner_product(const Lobe& a, const Lobe& b) {
    const Sum s = sum_of(a, b);
    return std::exp(s.log_amplitude) * integral(s.length);
}

double hemisphere_integral(double sharpness, double cosine) {
    return hemisphere_quadrature(sharpness, cosine, [](double) { return 1.0; });
}

double hemisphere_inner_product(const Lobe& a, const Lobe& b) {
    const Sum s = sum_of(a, b);
    const double cosine = s.length > 0 ? s.z / s.length : 1;
    return std::exp(s.log_amplitude) * hemisphere_integral(s.length, cosine);
}

ScaledLobe convolution(double sharpness_a, double sharpness_b) {
    const double r = mean_cosine(sharpness_a) * mean_cosine(sharpness_b);
    const double sharpness = sharpness_from_mean_cosine(r);
    return {{Vec3{0, 0, 1}, static_cast<float>(sharpness)},
            integral(sharpness_a) * integral(sharpness_b) / integral(sharpness)};
}

double mean_cosine(double sharpness) {
    const double s = sharpness;
    // Below 0.1 coth and 1 / lambda cancel; four terms of the series are good to 1e-11 there.
    if (s < 0.1) return s * (1.0 / 3 - s * s * (1.0 / 45 - s * s * (2.0 / 945 - s * s / 4725)));
    return 1 / std::tanh(s) - 1 / s;
}

double sharpness_from_mean_cosine(double r) {
    LOBELIA_ASSERT(r >= 0 && r < 1);
    // Banerjee's estimate, polished by Newton: L' = 1 - L^2 - 2 L / lambda.
    double s = r * (3 - r * r) / (1 - r * r);
    for (int i = 0; i < 8 && s > 1e-9; ++i) {
        const double l = mean_cosine(s);
        const double slope = s < 0.1 ? 1.0 / 3 - s * s / 15 : 1 - l * l - 2 * l / s;
        s = std::max(0.0, s - (l - r) / slope);
    }
    return s;
}

std::vector<double> irradiance_series(double sharpness, double tolerance) {
    // Ratios r_l = i_l / i_{l-1} by backward recurrence, well past the last term that counts.
    // A NaN has the shortest series, and what no float tells from infinity that of the largest.
    constexpr double most = 1e8;
    const auto last = static_cast<std::size_t>(20 + 9 * std::sqrt(std::min(std::max(0.0, sharpness), most)));
    std::vector<double> ratio(last + 2, 0.0);
    for (std::size_t l = last; l >= 1; --l)
        ratio[l] = sharpness / (static_cast<double>(2 * l + 1) + sharpness * ratio[l + 1]);

    // A_l of the clamped cosine goes from one even l to the next by the factor (1 - l) / (l + 4).
    std::vector<double> series;
    const double scale = integral(sharpness) / (4 * k_pi);
    double product = 1, even = harmonics::clamped_cosine(2);
    for (std::size_t l = 0; l <= last; ++l) {
        if (l > 0) product *= ratio[l];
        const auto n = static_cast<double>(l);
        const double cosine = l < 2 ? harmonics::clamped_cosine(l) : l % 2 == 0 ? even : 0;
        const double term = (2 * n + 1) * cosine * product;
        if (l > 2 && l % 2 == 0 && std::abs(term) < 4 * k_pi * tolerance) break;
        if (l >= 2 && l % 2 == 0) even *= (1 - n) / (n + 4);
        series.push_back(scale * term);
    }
    return series;
}

double zonal_sum(const std::vector<double>& series, double c) {
    double b1 = 0, b2 = 0;
    for (std::size_t l = series.size(); l-- > 0;) {
        const auto n = static_cast<double>(l);
        const double b0 = series[l] + (2 * n + 1) / (n + 1) * c * b1 - (n + 1) / (n + 2) * b2;
        b2 = b1;
        b1 = b0;
    }
    return b1;
}

double irradiance(double sharpness, double c) {
    // Use closed forms at the pole, opposite and across; below sharpness 1 they would cancel.
    const double s = sharpness, e = std::exp(-s);
    if (s >= 1 && c == 1) return 2 * k_pi * (s - 1 + e) / (s * s);
    if (s >= 1 && c == -1) return 2 * k_pi * e * (1 - e * (1 + s)) / (s * s);
    if (s >= 1 && c == 0) return 2 * k_pi * scaled_bessel_i(1, s) / s;
    return zonal_sum(irradiance_series(sharpness), c);
}

double irradiance_by_quadrature(double sharpness, double c) {
    return hemisphere_quadrature(sharpness, c, [](double cosine) { return cosine; });
}

}  // namespace lobelia::gaussian
