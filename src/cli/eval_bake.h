// The part of lobelia eval that reads whole bakes.
#pragma once

#include <string>

#include "lobelia/result.h"

namespace lobelia::cli {

struct EvalBakeOptions {
    std::string bake;
    std::string evaluator;  ///< empty: the codec's own
    std::string folder;     ///< where the pages of irradiance go
};

/// Writes irradiance at every texel's normal and prints the files' names.
[[nodiscard]] Status eval_bake(const EvalBakeOptions& options);

}  // namespace lobelia::cli
