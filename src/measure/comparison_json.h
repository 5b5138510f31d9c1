// A comparison as report.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "measure/comparison.h"

namespace lobelia {

/// Source of the environment.
struct EnvironmentInfo {
    std::string name;
    LatLong source;
    std::vector<std::string> warnings;
    std::size_t sanitized_texels = 0;
};

/// The content of report.json.
[[nodiscard]] nlohmann::json to_json(const Comparison& comparison, const EnvironmentInfo& environment);

}  // namespace lobelia
