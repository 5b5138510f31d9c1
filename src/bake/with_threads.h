// Parallel work on a given number of threads.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <optional>

namespace lobelia {

/// Calls `work` and returns its result; loops in it run on `threads` threads, or on one per processor if that is 0.
template <class Work>
auto with_threads(unsigned threads, const Work& work) {
    // Allow more threads than processors, or TBB reduces them and says so on stderr.
    using tbb::global_control;
    std::optional<global_control> limit;
    if (threads > global_control::active_value(global_control::max_allowed_parallelism))
        limit.emplace(global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
    return arena.execute(work);
}

}  // namespace lobelia
