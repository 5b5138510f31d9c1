// A bake's pages as pictures for its HTML page: one layer for each thing that a texel holds, reduced where pages are
// large.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/bake_page.h"
#include "report/picture.h"

namespace lobelia {

/// What the page's script calls layers, and their pictures, each named "<layer> <page>".
struct BakeLayers {
    std::vector<nlohmann::json> layers;
    std::map<std::string, Picture> pictures;
};
[[nodiscard]] BakeLayers bake_layers(const BakeReport& bake, const BakeReportOptions& options);

}  // namespace lobelia
