// Calls into C libraries that report errors by not returning.
#pragma once

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstddef>
#include <string_view>

namespace lobelia::io {

/// The way out of a C library: its error handler calls `leave`, and `run` returns false.
class Escape {
  public:
    /// Runs `step` and returns true, or false after `leave`. Precondition: `step` calls C functions only and creates no
    /// object with a destructor, as `leave` skips destructors; results are kept outside of it, not in its locals.
    template <class Step>
    [[nodiscard]] bool run(const Step& step) {
        if (setjmp(place_) != 0) return false;
        step();
        return true;
    }

    /// Returns to `run`, which is on the stack. Keeps the beginning of `message`.
    [[noreturn]] void leave(std::string_view message) {
        length_ = std::min(message.size(), message_.size());
        std::copy_n(message.begin(), length_, message_.begin());
        std::longjmp(place_, 1);
    }

    [[nodiscard]] std::string_view message() const { return {message_.data(), length_}; }

  private:
    std::jmp_buf place_{};
    std::array<char, 200> message_{};
    std::size_t length_ = 0;
};

}  // namespace lobelia::io
