// Progress of long measurements.
#pragma once

#include <functional>

namespace lobelia {

/// Receives the fraction done, in [0, 1]; called from any thread, never concurrently.
using Progress = std::function<void(double)>;

}  // namespace lobelia
