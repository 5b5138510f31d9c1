// Runs code with a limited number of threads.
#pragma once

#include <oneapi/tbb/global_control.h>

#include <cstddef>

namespace lobelia::test {

/// Returns the result of `run` with at most `threads` threads.
template <class Run>
auto with_threads(std::size_t threads, const Run& run) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run();
}

}  // namespace lobelia::test
