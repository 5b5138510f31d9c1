// Ctrl-C: stops the work, cleans up, and ends the program as the signal would have.
#pragma once

#include <atomic>

namespace lobelia::cli {

/// While it lives, the first SIGINT or SIGTERM asks the work to stop, and a second one ends the program. One at a time.
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
    void (*previous_interrupt_)(int);
    void (*previous_terminate_)(int);
};

}  // namespace lobelia::cli
