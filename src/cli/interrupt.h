// Ctrl-C: stops the work, cleans up, and ends the program as the signal would have.
#pragma once

#include <array>
#include <atomic>

#include "lobelia/result.h"

namespace lobelia::cli {

/// While it lives, the first SIGINT (Ctrl-C), SIGTERM or SIGHUP (the terminal is closed) asks the work to stop, and a
/// second one ends the program. Signals that are ignored, as under nohup, stay ignored. One at a time.
class StopOnInterrupt {
  public:
    StopOnInterrupt();
    ~StopOnInterrupt();
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

    /// Becomes true on the signal.
    [[nodiscard]] const std::atomic<bool>& flag() const;
    /// Ends the program by the signal that came, so that shells see what happened. Call it when all is tidy.
    static void end_program();

  private:
    using Handler = void (*)(int);
    std::array<Handler, 3> previous_{};
};

/// Returns the error of work that failed, or ends the program if it was the signal that ended the work.
[[nodiscard]] Error ended(Error error, const StopOnInterrupt& stop);

}  // namespace lobelia::cli
