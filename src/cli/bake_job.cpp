// The course of a job, from the scene's file to the finished folder.
#include "cli/bake_job.h"

#include <fmt/format.h>

#include <csignal>

#include "baker/merge.h"
#include "baker/output/bake_files.h"
#include "baker/preflight.h"
#include "cli/common.h"

namespace lobelia::cli {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> g_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// While it lives, Ctrl-C sets `stop` instead of ending the program; a second one ends it.
class StopOnInterrupt {
  public:
    StopOnInterrupt() {
        g_stop = false;
        previous_ = std::signal(SIGINT, [](int) {
            g_stop = true;
            std::signal(SIGINT, SIG_DFL);
        });
    }
    ~StopOnInterrupt() { std::signal(SIGINT, previous_); }
    StopOnInterrupt(const StopOnInterrupt&) = delete;
    StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
    [[nodiscard]] const std::atomic<bool>& flag() const { return g_stop; }

  private:
    void (*previous_)(int);
};

}  // namespace

}  // namespace lobelia::cli
