// The study of encoders: excess error against the number of samples, with and without the noise of a path tracer.
#pragma once

#include "measure/convergence.h"
#include "measure/study/study.h"

namespace lobelia {

struct EncoderStudyOptions {
    std::size_t repetitions = 64;
    std::uint32_t seed = 1;
    /// Variance of the path noise: each sample's radiance is multiplied by a lognormal factor of mean 1.
    double noise_variance = 3;
};

/// The first listed basis of each domain.
[[nodiscard]] std::vector<std::string> default_study_bases();

/// For each basis one table of relative excess errors, and one of absolute ones (root mean square radiance), with
/// every encoder, listed or not, that works with it. `bases` (linear ones) and `environment` as for compare().
[[nodiscard]] Result<Study> study_encoders(const Image& environment, const std::vector<std::string>& bases,
                                           const EncoderStudyOptions& options = {}, const Progress& progress = {});

}  // namespace lobelia
