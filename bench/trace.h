// Benchmarks of light transport.
#pragma once

namespace lobelia::bench {

/// Registers the benchmarks trace.*.
void register_trace();

}  // namespace lobelia::bench
