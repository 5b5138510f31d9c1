// Errors of one set of colours against another.
#pragma once

#include "lobelia/planes.h"

#include <span>

namespace lobelia {

/// Errors of colours a against a reference r over entries with weights w. All means run over the three channels too.
struct Errors {
    double rms = 0;             ///< sqrt(sum w (a - r)^2 / sum w)
    double rms_unweighted = 0;  ///< the same with every entry counted once
    double smape = 0;           ///< weighted mean of |a - r| / (|a| + |r|), 0 where both are 0
    double relmse = 0;          ///< weighted mean of (a - r)^2 / (r^2 + 0.01)
    double negative_share = 0;  ///< see negative_share()
    double worst = 0;           ///< largest RMS over the channels of one entry
    std::size_t worst_index = 0;
};

/// Returns the weighted fraction of entries with a channel below 0.
[[nodiscard]] double negative_share(ColourView a, std::span<const float> weights);

/// Computes all errors. Preconditions: all three have one size, weights >= 0.
[[nodiscard]] Errors errors(ColourView a, ColourView reference, std::span<const float> weights);

}  // namespace lobelia
