// Convergence of encoders: excess error against the number of samples, for point sequences.
#pragma once

#include "measure/comparison.h"

namespace lobelia {

/// A basis, and the encoders and sequences to measure.
struct ConvergenceTask {
    std::shared_ptr<const Basis> basis;  ///< a linear one
    std::vector<std::string> encoders;
    std::vector<std::optional<Sequence>> sequences;  ///< none: that many of the environment's own texels
};

struct ConvergenceOptions {
    std::vector<std::size_t> counts = {16, 64, 256, 1024, 4096, 16384};
    std::size_t repetitions = 4;
    std::uint32_t seed = 1;
    /// Path noise: each radiance is multiplied by a lognormal factor of mean 1 and this variance; 0 is none.
    double noise_variance = 0;
};

/// |b|_G^2 over all channels; G is the exact Gram matrix, so that this is the integral of the squared radiance.
[[nodiscard]] double squared_norm(const Matrix& gram, std::span<const Rgb> b);

/// Every count has its own point set, shuffled; excesses are root mean squares over the repetitions. Texels count by
/// their solid angle. Parallel, with the same figures at any thread count.
[[nodiscard]] std::vector<Convergence> measure_convergence(const Image& environment,
                                                           const std::vector<ConvergenceTask>& tasks,
                                                           const ConvergenceOptions& options = {},
                                                           const Progress& progress = {});

}  // namespace lobelia
