// Encoders whose state is a sum of moments: m = sum w B v and, where wanted, G = sum w B B^T. Several solvers read
// them. Roughton 2018, where streaming moments are credited to P.-P. Sloan; Bro and de Jong 1997 (fast NNLS); the
// blended moments and the joint norm are new.
#pragma once

#include "core/math/least_squares.h"
#include "lobelia/encoder.h"

namespace lobelia {

/// projection: c_i = s m_i, with one s such that a constant environment keeps its energy; exact for orthonormal bases.
/// analytic_gram: G c = m with the exact Gram matrix. sampled_gram: with the sampled one, which is batch least squares.
/// regularised: their blend (1 - k) sampled + k exact, k = n / (n + N + N^2 / 8n), n coefficients, N samples, and the
/// moments blended likewise with those of the constant environment of the sampled mean: good at every count.
/// non_negative: batch least squares with c >= 0 per channel. joint, joint_non_negative: the least
/// |fit - L|^2 / |L|^2 + w |E_fit - E|^2 / |E|^2, radiance and irradiance together, blended as the regularised form.
enum class MomentSolver {
    projection,
    analytic_gram,
    sampled_gram,
    regularised,
    non_negative,
    joint,
    joint_non_negative
};

struct MomentOptions {
    double irradiance_weight = 1;  ///< w of the joint norm, 0 and up
};

[[nodiscard]] std::shared_ptr<const Encoder> make_moment_encoder(std::shared_ptr<const LinearBasis> basis,
                                                                 MomentSolver solver,
                                                                 const MomentOptions& options = {});

}  // namespace lobelia
