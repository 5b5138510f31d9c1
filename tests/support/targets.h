// Runs code with one instruction set after the other.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>

namespace lobelia::test {

/// Allows only `targets` during its lifetime.
class OnlyTargets {
  public:
    explicit OnlyTargets(std::int64_t targets) { hwy::SetSupportedTargetsForTest(targets); }
    ~OnlyTargets() { hwy::SetSupportedTargetsForTest(0); }
    OnlyTargets(const OnlyTargets&) = delete;
    OnlyTargets& operator=(const OnlyTargets&) = delete;
};

/// Calls `run` with each compiled instruction set that this machine has; a trace names the one that fails.
template <class Run>
void on_all_targets(const Run& run) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        const OnlyTargets only(target);
        SCOPED_TRACE(hwy::TargetName(target));
        run();
    }
}

}  // namespace lobelia::test
