// Signal handlers; they can reach nothing but what is in this file.
#include "cli/interrupt.h"

#include <csignal>

#include "cli/common.h"

namespace lobelia::cli {
namespace {

std::atomic<bool> interrupted = false;
std::atomic<int> signal_that_came = SIGINT;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

constexpr std::array k_signals{SIGINT, SIGTERM, SIGHUP};

void ask_to_stop(int signal) {
    interrupted = true;
    signal_that_came = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
    interrupted = false;
    for (std::size_t i = 0; i < k_signals.size(); ++i) {
        struct sigaction now {};
        const bool is_ignored = sigaction(k_signals[i], nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
        previous_[i] = is_ignored ? SIG_IGN : std::signal(k_signals[i], ask_to_stop);
    }
}

StopOnInterrupt::~StopOnInterrupt() {
    for (std::size_t i = 0; i < k_signals.size(); ++i) std::signal(k_signals[i], previous_[i]);
}

const std::atomic<bool>& StopOnInterrupt::flag() const { return interrupted; }

void StopOnInterrupt::end_program() {
    std::signal(signal_that_came, SIG_DFL);
    std::raise(signal_that_came);
}

Error ended(Error error, const StopOnInterrupt& stop) {
    if (stop.flag()) {
        complain("lobelia: stopped");
        StopOnInterrupt::end_program();
    }
    return error;
}

}  // namespace lobelia::cli
