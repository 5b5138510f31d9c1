// The degree-1 SH bake, step by step: from projection and convolution to sums without factors and stored ratios.
// Each step is a function, and all give the same irradiance; docs/sh-baking.md derives them.
// Ramamoorthi and Hanrahan 2001; Sloan 2008.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lobelia/sample.h"

namespace lobelia::sh_baking {

/// A constant and a vector, for each colour channel: what a polynomial of degree 1 in a direction needs.
struct Degree1 {
    Rgb constant;
    std::array<Rgb, 3> along;  ///< of x, y and z
};

// Samples are uniform over their domain throughout: every one has the share |domain| / N, whatever its own solid angle
// says. The hemisphere is z >= 0, with nothing below.

/// Step 1, projection: c_i = |domain| / N sum_j L_j Y_i(d_j), with Y_0 = sqrt(1 / 4 pi) and Y_1 = sqrt(3 / 4 pi) d.
[[nodiscard]] Degree1 projection(SampleView samples, Domain domain);
/// Step 2, convolution with the clamped cosine: A_0 = pi, A_1 = 2 pi / 3.
[[nodiscard]] Degree1 convolved(const Degree1& coefficients);
/// E(n) = sum_i c_i Y_i(n) of convolved coefficients.
[[nodiscard]] Rgb irradiance_of_convolved(const Degree1& convolved, Vec3 n);

/// Step 3, merged: both harmonics and the convolution are factors of the sums, A_l Y_l^2 = 1/4 and 1/2:
/// |domain| / N sum_j L_j / 4 and |domain| / N sum_j L_j d_j / 2.
[[nodiscard]] Degree1 merged(SampleView samples, Domain domain);
/// E(n) = constant + along . n of merged sums.
[[nodiscard]] Rgb irradiance_of_merged(const Degree1& merged, Vec3 n);

/// Step 4, without factors: the means of L and of L d over the samples, L0 and L1.
[[nodiscard]] Degree1 means(SampleView samples);
/// E(n) / pi = (0.5 + L1 / L0 . n) L0 f, with f = 2 over the sphere and 1 over the hemisphere, written without the
/// division.
[[nodiscard]] Rgb irradiance_over_pi_of_means(const Degree1& means, Vec3 n, Domain domain);

/// Step 5, storage: L0, and L1 / L0, whose components lie in [-1, 1] for light that is >= 0, as numbers in [0, 1].
struct Stored {
    Rgb L0;
    std::array<Rgb, 3> L1;  ///< 0.5 + 0.5 L1 / L0 of x, y and z; 0.5 where L0 is 0
};
[[nodiscard]] Stored stored(const Degree1& means);
[[nodiscard]] Degree1 means_of_stored(const Stored& stored);

/// Step 6, reconstruction: with L1 scaled back to [-1, 1], (0.5 + L1 . n) L0 f.
[[nodiscard]] Rgb irradiance_over_pi_of_stored(const Stored& stored, Vec3 n, Domain domain);

/// SH coefficients (index l^2 + l + m, as the basis of degree 1 has them) of the light whose means these are, and back.
[[nodiscard]] std::vector<Rgb> coefficients_of_means(const Degree1& means, Domain domain);
[[nodiscard]] Degree1 means_of_coefficients(std::span<const Rgb> c, Domain domain);

}  // namespace lobelia::sh_baking
