// Single spherical Gaussians G(s) = exp(lambda (s . p - 1)) in double precision: closed forms, exact irradiance.
// Wang et al. 2009; Tsai and Shih 2006; Mardia and Jupp 2000 (von Mises-Fisher).
#pragma once

#include <vector>

#include "lobelia/bases.h"

namespace lobelia::gaussian {

using lobelia::Lobe;

/// A lobe times `amplitude`.
struct ScaledLobe {
    Lobe lobe;
    double amplitude = 1;
};

/// All of these hold for sharpness 0 to 10^4.

/// Integral over the sphere [sr], 2 pi (1 - e^(-2 lambda)) / lambda; 4 pi at 0.
[[nodiscard]] double integral(double sharpness);
/// The product of two lobes is exactly a scaled lobe.
[[nodiscard]] ScaledLobe product(const Lobe& a, const Lobe& b);
/// Integral of the product over the sphere.
[[nodiscard]] double inner_product(const Lobe& a, const Lobe& b);
/// Integral of a lobe over the hemisphere z >= 0, `cosine` its axis's z; Gauss-Legendre to about 1e-12 of `integral`.
[[nodiscard]] double hemisphere_integral(double sharpness, double cosine);
/// Integral of the product over the hemisphere z >= 0.
[[nodiscard]] double hemisphere_inner_product(const Lobe& a, const Lobe& b);
/// The lobe nearest to the spherical convolution of two zonal lobes: its integral is exactly the product of theirs and
/// its mean cosine exactly the product of theirs. Sharpness in, scaled sharpness out (axis +z).
[[nodiscard]] ScaledLobe convolution(double sharpness_a, double sharpness_b);

/// Mean cosine L(lambda) = coth lambda - 1 / lambda of the normalised lobe (Langevin function), and its inverse.
[[nodiscard]] double mean_cosine(double sharpness);
[[nodiscard]] double sharpness_from_mean_cosine(double r);

/// Zonal series of the irradiance of a unit lobe: E(c) = sum_l term_l P_l(c), c the cosine between normal and axis,
/// term_l = I (2l + 1) / (4 pi) A_l i_l(lambda) / i_0(lambda), until the terms are below `tolerance` * I.
[[nodiscard]] std::vector<double> irradiance_series(double sharpness, double tolerance = 1e-17);
/// Sum of a zonal series at c (Clenshaw).
[[nodiscard]] double zonal_sum(const std::vector<double>& series, double c);
/// Exact irradiance of a unit lobe, by the zonal series.
[[nodiscard]] double irradiance(double sharpness, double c);
/// The same by one-dimensional quadrature: an independent check.
[[nodiscard]] double irradiance_by_quadrature(double sharpness, double c);

}  // namespace lobelia::gaussian
