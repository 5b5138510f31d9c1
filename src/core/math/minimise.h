// The least value of a smooth function of a few dozen variables: limited-memory quasi-Newton steps (L-BFGS).
// Nocedal 1980; Liu and Nocedal 1989.
#pragma once

#include <functional>
#include <span>

namespace lobelia {

struct MinimiseOptions {
    std::size_t most_steps = 60;
    std::size_t history = 6;     ///< pairs of steps and changes of gradient that are kept
    double first_step = 0.1;     ///< largest move of a variable in the first step
    double longest_step = 1;     ///< and in any
    double least_change = 1e-9;  ///< done when a step lowers f by less than this of its value
};

/// f and its gradient at x.
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

/// Moves x downhill to a local minimum; returns f there. f never rises on the way.
double minimise(const Objective& f, std::span<double> x, const MinimiseOptions& options = {});

}  // namespace lobelia
