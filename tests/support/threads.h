// Tests at a given number of threads.
#pragma once

#include <oneapi/tbb/global_control.h>

#include <cstddef>

namespace lobelia::test {

/// What `run` returns when at most `threads` threads run it.
template <class Run>
auto with_threads(std::size_t threads, const Run& run) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run();
}

}  // namespace lobelia::test
