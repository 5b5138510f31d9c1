// Long work beside the interpreter: progress for Python, and Ctrl-C within a twentieth of a second.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "arrays.h"

namespace lobelia::python {

/// Runs `work(stop, report)` in a thread of its own, while this one lets other Python threads run, hands the latest
/// value that `report` received to `progress`, and looks for signals. A signal's exception, KeyboardInterrupt, and one
/// of `progress` set `stop`; they are raised once the work has ended.
template <class Progress, class Work>
auto run_interruptibly(const py::object& progress, const Work& work) {
    using Output = decltype(work(std::declval<const std::atomic<bool>&>(), std::declval<void (*)(const Progress&)>()));
    std::atomic<bool> stop = false;
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Progress> latest;
    std::optional<Output> output;
    std::exception_ptr failure, interruption;
    bool done = false;

    std::thread worker([&] {
        try {
            output.emplace(work(stop, [&](const Progress& value) {
                const std::lock_guard lock(mutex);
                latest = value;
            }));
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        done = true;
        changed.notify_one();
    });
    const auto call_python = [&](const std::optional<Progress>& value) {
        try {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
            if (value && !progress.is_none() && !stop) progress(*value);
        } catch (...) {
            if (!interruption) interruption = std::current_exception();
            stop = true;
        }
    };
    for (bool running = true; running;) {
        std::optional<Progress> value;
        {
            py::gil_scoped_release released;
            std::unique_lock lock(mutex);
            changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; });
            running = !done;
            value.swap(latest);
        }
        call_python(value);
    }
    {
        py::gil_scoped_release released;
        worker.join();
    }
    if (interruption) std::rethrow_exception(interruption);
    if (failure) std::rethrow_exception(failure);
    return *std::move(output);
}

}  // namespace lobelia::python
