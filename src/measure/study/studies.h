// THE list of studies of formulae.
#pragma once

#include <span>
#include <string_view>

#include "measure/study/study.h"

namespace lobelia {

/// Studies of formulae that bases bring with them.
struct StudyEntry {
    std::string_view name, description;
    Study (*run)();
};
[[nodiscard]] std::span<const StudyEntry> studies();

}  // namespace lobelia
