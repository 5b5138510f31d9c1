// Coefficients of an environment.
#pragma once

#include <optional>

#include "coefficients/coefficient_file.h"
#include "lobelia/image.h"
#include "lobelia/sampling.h"

namespace lobelia {

/// Which samples of an environment an encoder sees.
struct SamplingOptions {
    std::optional<Sequence> sequence = {};    ///< none: every texel is one sample, once, shuffled
    std::optional<std::size_t> samples = {};  ///< none: all texels, or k_default_sequence_samples of a sequence
    std::uint32_t seed = 1;                   ///< of the sequence and of the shuffle
    std::size_t most_texels = 131072;         ///< larger environments are reduced first, energy kept
};

inline constexpr std::size_t k_default_sequence_samples = 20000;

/// Samples of a domain in the order in which encoders see them.
[[nodiscard]] Samples environment_samples(const Image& environment, Domain domain, const SamplingOptions& options = {});

/// Encodes an environment with the codec of that name. Error: an unknown codec, or coefficients that are not finite.
[[nodiscard]] Result<CoefficientFile> encode(const Image& environment, const std::string& codec,
                                             const SamplingOptions& options = {});

}  // namespace lobelia
