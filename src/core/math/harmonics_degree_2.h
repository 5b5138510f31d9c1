// Degree-2 harmonics of one channel as the polynomial that they are.
#pragma once

#include <array>
#include <span>

#include "lobelia/math.h"

namespace lobelia {

[[nodiscard]] constexpr float channel_of(Rgb c, std::size_t k) { return k == 0 ? c.r : k == 1 ? c.g : c.b; }
constexpr void set_channel(Rgb& c, std::size_t k, double value) {
    (k == 0 ? c.r : k == 1 ? c.g : c.b) = static_cast<float>(value);
}

/// L(w) = constant + linear . w + w^T M w, M symmetric and without trace.
struct Degree2 {
    double constant = 0;
    std::array<double, 3> linear{};
    std::array<std::array<double, 3>, 3> form{};

    [[nodiscard]] double first(const std::array<double, 3>& w) const {
        return linear[0] * w[0] + linear[1] * w[1] + linear[2] * w[2];
    }
    [[nodiscard]] double second(const std::array<double, 3>& w) const {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) sum += w[i] * form[i][j] * w[j];
        return sum;
    }
};

/// Channel k of nine coefficients.
[[nodiscard]] inline Degree2 degree_2(std::span<const Rgb> c, std::size_t k) {
    const auto at = [&](std::size_t i) -> double { return channel_of(c[i], k); };
    const double one = std::sqrt(3 / (4 * k_pi)), two = std::sqrt(15 / (4 * k_pi)) / 2,
                 zonal = std::sqrt(5 / (16 * k_pi));
    const double xy = two * at(4), yz = two * at(5), xz = two * at(7), xx = two * at(8), zz = zonal * at(6);
    return {std::sqrt(1 / (4 * k_pi)) * at(0),
            {one * at(3), one * at(1), one * at(2)},
            {{{xx - zz, xy, xz}, {xy, -xx - zz, yz}, {xz, yz, 2 * zz}}}};
}

}  // namespace lobelia
