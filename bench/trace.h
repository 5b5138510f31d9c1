// Benchmarks of light transport.
#pragma once

namespace lobelia::bench {

/// Adds the rows trace.*.
void register_trace();

}  // namespace lobelia::bench
