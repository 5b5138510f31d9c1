// Encoders as values: sums of moments with several solvers, and estimates that each sample corrects.
// Roughton 2018, where streaming moments are credited to P.-P. Sloan, and 2020 (the running average and its corrected
// form); Bro and de Jong 1997 (fast NNLS). The blended moments, the joint norm and the matrix gain are new.
#pragma once

#include <optional>

#include "lobelia/encoder.h"

namespace lobelia {

// ---- Encoders whose state is a sum: m = sum w B v and, where needed, G = sum w B B^T ----

/// projection: c_i = s m_i, with one s such that a constant environment keeps its energy; exact for orthonormal bases.
/// analytic_gram: G c = m with the exact Gram matrix.
/// sampled_gram: with the sampled one; equals batch least squares.
/// regularised: the blend (1 - k) sampled + k exact, k = n / (n + N + N^2 / 8n), n coefficients, N samples, with the
/// moments blended likewise with those of a constant environment of the sampled mean; accurate at every count.
/// non_negative: batch least squares with c >= 0 per channel.
/// joint, joint_non_negative: minimises |fit - L|^2 / |L|^2 + w |E_fit - E|^2 / |E|^2, radiance and irradiance
/// together, blended as in the regularised form.
enum class MomentSolver {
    projection,
    analytic_gram,
    sampled_gram,
    regularised,
    non_negative,
    joint,
    joint_non_negative
};

/// Relative increase of the diagonal of a sampled Gram matrix before it is solved: above the resolution of float32
/// sums.
inline constexpr double k_gram_ridge = 1e-6;

struct MomentOptions {
    double irradiance_weight = 1;  ///< w of the joint norm, >= 0
};

[[nodiscard]] std::shared_ptr<const Encoder> make_moment_encoder(std::shared_ptr<const LinearBasis> basis,
                                                                 MomentSolver solver,
                                                                 const MomentOptions& options = {});

// ---- Encoders that hold an estimate and correct it with each sample ----

enum class Sign { any, non_negative };

/// Makes a running average, original form: b_i += (v - est) w_i / sum w_i.
[[nodiscard]] std::shared_ptr<const Encoder> make_running_average(std::shared_ptr<const LinearBasis> basis, Sign sign);

/// Progressive least squares: b_i += ((v - sum_{k != i} b_k w_k) w_i / S_i - b_i) a, a the sample's fraction so far.
struct ProgressiveOptions {
    /// S_i, the mean of B_i^2: sampled, exact, or the larger of both (clamped).
    enum class Denominator { clamped, sampled, exact } denominator = Denominator::clamped;
    /// Initial value of the running mean for `sampled`, in place of the first sample's square, which may be tiny and is
    /// divided by; absent: the exact mean.
    std::optional<float> first_mean_square = {};
    /// Reduces the weight of early samples to 1 - e^(-i / ramp); absent: all have the same weight.
    std::optional<double> ramp = {};
    /// Initial coefficients, found from fewer samples; empty: 0. Precondition: size 0 or basis size.
    std::vector<Rgb> seed = {};
    /// The later variant: S_i = a + (1 - a) m_i (overrides `denominator`), gain times this value, each lobe including
    /// the corrections of those before it; absent: the plain form. Published with 3.
    std::optional<double> acceleration = {};
};
[[nodiscard]] std::shared_ptr<const Encoder> make_progressive(std::shared_ptr<const LinearBasis> basis, Sign sign,
                                                              const ProgressiveOptions& options = {});

/// Makes b += G^-1 w (v - w . b) / (N + n), n coefficients, N samples so far: converges like batch least squares with
/// the memory of the running average. Intermediate values must not be clamped; for non-negative output use the
/// non-negative moments.
[[nodiscard]] std::shared_ptr<const Encoder> make_matrix_gain(std::shared_ptr<const LinearBasis> basis);

}  // namespace lobelia
