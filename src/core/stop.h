// Early ends of long work: loops ask a flag that somebody else sets, such as the handler of Ctrl-C.
//
//   unless_stopped([&]() -> Status {
//       for (Row& row : rows) {
//           stop.check();  // throws out of any depth, out of parallel loops too
//           work_on(row);
//       }
//       return Done{};
//   });
#pragma once

#include <atomic>

#include "lobelia/result.h"

namespace lobelia {

/// Thrown by StopFlag::check. It never leaves the library: whoever was given the flag calls unless_stopped.
struct Stopped {};

/// Refers to a flag that asks work to end; by default to none. Small and cheap to copy.
class StopFlag {
  public:
    StopFlag() = default;
    /// Null: never set.
    StopFlag(const std::atomic<bool>* flag) : flag_(flag) {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] const std::atomic<bool>* flag() const { return flag_; }
    [[nodiscard]] bool is_set() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }
    /// Throws Stopped if the flag is set. One relaxed load: cheap enough for each row, triangle or probe.
    void check() const {
        if (is_set()) throw Stopped{};
    }

  private:
    const std::atomic<bool>* flag_ = nullptr;
};

/// Returns the error of work that was stopped.
[[nodiscard]] inline Error stopped_error() { return Error{"stopped", Error::Kind::stopped}; }

/// Returns `work()`, a Result or Status; an error if it was stopped.
template <class Work>
auto unless_stopped(const Work& work) -> decltype(work()) {
    try {
        return work();
    } catch (const Stopped&) {
        return stopped_error();
    }
}

}  // namespace lobelia
