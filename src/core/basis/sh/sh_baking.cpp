// The steps of the degree-1 SH bake.
#include "core/basis/sh/sh_baking.h"

#include <cmath>

namespace lobelia::sh_baking {
namespace {

const auto k_Y0 = static_cast<float>(std::sqrt(1 / (4 * k_pi)));
const auto k_Y1 = static_cast<float>(std::sqrt(3 / (4 * k_pi)));
constexpr auto k_A0 = static_cast<float>(k_pi), k_A1 = static_cast<float>(2 * k_pi / 3);

/// Sums over the samples of factor0 L and of factor1 L d, in double precision.
Degree1 sums(SampleView samples, double factor0, double factor1) {
    double total[4][3] = {};
    for (std::size_t j = 0; j < samples.size; ++j) {
        const Vec3 d = direction_at(samples.directions(), j);
        const Rgb L = colour_at(samples.radiance(), j);
        const double functions[4] = {factor0, factor1 * d.x, factor1 * d.y, factor1 * d.z};
        for (std::size_t i = 0; i < 4; ++i) {
            total[i][0] += functions[i] * L.r;
            total[i][1] += functions[i] * L.g;
            total[i][2] += functions[i] * L.b;
        }
    }
    const auto colour = [&](std::size_t i) {
        return Rgb{static_cast<float>(total[i][0]), static_cast<float>(total[i][1]), static_cast<float>(total[i][2])};
    };
    return {colour(0), {colour(1), colour(2), colour(3)}};
}

/// |domain| / N.
double share(SampleView samples, Domain domain) {
    LOBELIA_ASSERT(samples.size > 0);
    return solid_angle(domain) / static_cast<double>(samples.size);
}

Rgb dot(const std::array<Rgb, 3>& v, Vec3 n) { return v[0] * n.x + v[1] * n.y + v[2] * n.z; }

Degree1 scaled(const Degree1& v, float constant, float along) {
    return {v.constant * constant, {v.along[0] * along, v.along[1] * along, v.along[2] * along}};
}

template <class F>
Rgb each_channel(Rgb a, Rgb b, const F& f) {
    return {f(a.r, b.r), f(a.g, b.g), f(a.b, b.b)};
}

/// Returns the factor from a mean over the domain to E / pi: |domain| / pi times 1/4, and times 1/2.
constexpr float half_factor(Domain domain) { return domain == Domain::sphere ? 2 : 1; }

}  // namespace

Degree1 projection(SampleView samples, Domain domain) {
    const double omega = share(samples, domain);
    return sums(samples, omega * std::sqrt(1 / (4 * k_pi)), omega * std::sqrt(3 / (4 * k_pi)));
}

Degree1 convolved(const Degree1& coefficients) { return scaled(coefficients, k_A0, k_A1); }

Rgb irradiance_of_convolved(const Degree1& convolved, Vec3 n) {
    return convolved.constant * k_Y0 + dot(convolved.along, n) * k_Y1;
}

Degree1 merged(SampleView samples, Domain domain) {
    const double omega = share(samples, domain);
    return sums(samples, omega / 4, omega / 2);
}

Rgb irradiance_of_merged(const Degree1& merged, Vec3 n) { return merged.constant + dot(merged.along, n); }

Degree1 means(SampleView samples) {
    LOBELIA_ASSERT(samples.size > 0);
    const double share = 1 / static_cast<double>(samples.size);
    return sums(samples, share, share);
}

Rgb irradiance_over_pi_of_means(const Degree1& means, Vec3 n, Domain domain) {
    return (means.constant * 0.5f + dot(means.along, n)) * half_factor(domain);
}

Stored stored(const Degree1& means) {
    Stored result{means.constant, {}};
    for (std::size_t i = 0; i < 3; ++i)
        result.L1[i] = each_channel(means.along[i], means.constant,
                                    [](float L1, float L0) { return L0 > 0 ? 0.5f + 0.5f * (L1 / L0) : 0.5f; });
    return result;
}

Degree1 means_of_stored(const Stored& stored) {
    Degree1 result{stored.L0, {}};
    for (std::size_t i = 0; i < 3; ++i)
        result.along[i] = each_channel(stored.L1[i], stored.L0, [](float L1, float L0) { return (2 * L1 - 1) * L0; });
    return result;
}

Rgb irradiance_over_pi_of_stored(const Stored& stored, Vec3 n, Domain domain) {
    const Rgb L1n = dot(stored.L1, n) * 2.0f - Rgb{1, 1, 1} * (n.x + n.y + n.z);
    return each_channel(L1n, stored.L0, [&](float L1, float L0) { return (0.5f + L1) * L0 * half_factor(domain); });
}

std::vector<Rgb> coefficients_of_means(const Degree1& means, Domain domain) {
    const auto omega = static_cast<float>(solid_angle(domain));
    const Degree1 c = scaled(means, omega * k_Y0, omega * k_Y1);
    return {c.constant, c.along[1], c.along[2], c.along[0]};
}

Degree1 means_of_coefficients(std::span<const Rgb> c, Domain domain) {
    check_equal("coefficients", c.size(), 4);
    const auto omega = static_cast<float>(solid_angle(domain));
    return scaled({c[0], {c[3], c[1], c[2]}}, 1 / (omega * k_Y0), 1 / (omega * k_Y1));
}

}  // namespace lobelia::sh_baking
