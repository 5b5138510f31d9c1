// Highway's choice of instruction set, by name.
#include "lobelia/simd.h"

#include <hwy/highway.h>

#include <bit>

namespace lobelia {
namespace {

/// Highway's bit for the target in use: the lowest of those compiled and supported is the fastest.
std::int64_t current() {
    const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
    return usable & -usable;
}

/// Those that the machine and the build have, as they were before any was chosen.
const std::vector<std::int64_t>& all_targets() {
    static const std::vector<std::int64_t> once = hwy::SupportedAndGeneratedTargets();
    return once;
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace

std::vector<std::string> simd_targets() {
    std::vector<std::string> names;
    for (const std::int64_t target : all_targets()) names.emplace_back(hwy::TargetName(target));
    return names;
}

std::string_view simd_target() { return hwy::TargetName(current()); }

Status use_simd_target(std::string_view name) {
    for (const std::int64_t target : all_targets()) {
        if (hwy::TargetName(target) != name) continue;
        hwy::DisableTargets(~target);
        return Done{};
    }
    return Error{"instruction set \"" + std::string(name) +
                 "\" is not one that this build and this machine have: " + listed(simd_targets())};
}

std::uint32_t simd_target_id() {
    return 1 + static_cast<std::uint32_t>(std::countr_zero(static_cast<std::uint64_t>(current())));
}

std::string_view simd_target_name(std::uint32_t id) {
    const char* name = id >= 1 && id <= 63 ? hwy::TargetName(std::int64_t{1} << (id - 1)) : "Unknown";
    return std::string_view(name) == "Unknown" ? "an unknown instruction set" : name;
}

}  // namespace lobelia
