// The comparison as report.json, coefficients as files, and pictures for the page.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "measure/comparison.h"
#include "report/html.h"

namespace lobelia {

/// What the report says of where the environment came from.
struct EnvironmentInfo {
    std::string name;
    LatLong source;
    std::vector<std::string> warnings;
    std::size_t sanitized_texels = 0;
};

[[nodiscard]] nlohmann::json to_json(const Comparison& comparison, const EnvironmentInfo& environment);

[[nodiscard]] PictureSet to_pictures(const Comparison& comparison);

/// Coefficients with the codec that they belong to: what `lobelia encode` writes and `lobelia eval` reads.
struct CoefficientFile {
    CodecName codec;
    std::vector<Rgb> c;
};

[[nodiscard]] nlohmann::json to_json(const CoefficientFile& file);

/// Reads a coefficient file's text; `name` is what messages call it. Refuses other versions, unknown codecs, a wrong
/// number of coefficients and values that are not finite.
[[nodiscard]] Result<CoefficientFile> coefficients_from_json(std::string_view text, const std::string& name);

}  // namespace lobelia
