// The lightmap pages of a bake as pictures for its report: one layer for each quantity of a texel; large pages are
// reduced.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/bake_report.h"
#include "report/picture.h"

namespace lobelia {

/// Layers as the report's scripts take them, and their pictures, each named "<layer> <page>".
struct BakeLayers {
    std::vector<nlohmann::json> layers;
    std::map<std::string, Picture> pictures;
};
[[nodiscard]] BakeLayers bake_layers(const BakeReport& bake, const BakeReportOptions& options);

}  // namespace lobelia
