// Least squares: the non-negative kind from normal equations, and the oracle by QR.
// Lawson and Hanson 1974; Bro and de Jong 1997.
#pragma once

#include "lobelia/basis.h"

namespace lobelia {

/// The b >= 0 with the least b^T G b - 2 m^T b, G symmetric positive definite (row by row): fast NNLS.
[[nodiscard]] std::vector<double> non_negative_least_squares(const Matrix& gram, std::span<const double> m);

/// Ordinary least squares by Householder QR on the full design matrix, in double precision: the oracle. Slow and
/// memory-hungry on purpose: samples x size().
[[nodiscard]] std::vector<Rgb> least_squares_by_qr(const LinearBasis& basis, SampleView samples);

}  // namespace lobelia
