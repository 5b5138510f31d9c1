// Signal handlers; they can reach nothing but what is in this file.
#include "cli/interrupt.h"

#include <csignal>

namespace lobelia::cli {
namespace {

std::atomic<bool> interrupted = false;
std::atomic<int> signal_that_came = SIGINT;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void ask_to_stop(int signal) {
    interrupted = true;
    signal_that_came = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
    interrupted = false;
    previous_interrupt_ = std::signal(SIGINT, ask_to_stop);
    previous_terminate_ = std::signal(SIGTERM, ask_to_stop);
}

StopOnInterrupt::~StopOnInterrupt() {
    std::signal(SIGINT, previous_interrupt_);
    std::signal(SIGTERM, previous_terminate_);
}

const std::atomic<bool>& StopOnInterrupt::flag() const { return interrupted; }

void StopOnInterrupt::end_program() {
    std::signal(signal_that_came, SIG_DFL);
    std::raise(signal_that_came);
}

}  // namespace lobelia::cli
