// How fast encoders converge: excess error against the number of samples, for point sequences.
#pragma once

#include "report/comparison.h"

namespace lobelia {

/// A basis, and which encoders to follow with which sequences.
struct ConvergenceTask {
    std::shared_ptr<const Basis> basis;
    std::vector<std::string> encoders;
    std::vector<Sequence> sequences;
};

struct ConvergenceOptions {
    std::vector<std::size_t> counts = {16, 64, 256, 1024, 4096, 16384};
    std::size_t repetitions = 4;
    std::uint32_t seed = 1;
};

/// |b - b*|_G / |b*|_G over all channels; G is the exact Gram matrix.
[[nodiscard]] double excess_error(const Matrix& gram, std::span<const Rgb> b, std::span<const Rgb> converged);

/// Every count has its own point set, shuffled; excesses are root mean squares over the repetitions. Parallel.
[[nodiscard]] std::vector<Convergence> measure_convergence(const Image& environment,
                                                           const std::vector<ConvergenceTask>& tasks,
                                                           const ConvergenceOptions& options = {});

}  // namespace lobelia
