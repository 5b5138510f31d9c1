// The report of a comparison: one HTML file that opens anywhere, offline, with its pictures as half floats inside.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "measure/comparison.h"
#include "report/picture.h"

namespace lobelia {

/// All pictures of a report, latitude-longitude, linear: radiance [W/(m^2 sr)] and irradiance over pi [W/(m^2 sr)].
/// A picture may be any size, and may be missing: the page then leaves its place empty.
struct PictureSet {
    struct Reference {
        Picture radiance;
        Picture irradiance_over_pi;
    };
    std::map<std::string, Reference> references;        ///< by domain: "sphere", "hemisphere"
    std::map<std::string, Picture> radiance;            ///< by "basis/encoder": before any evaluator cuts it
    std::map<std::string, Picture> irradiance_over_pi;  ///< by the method's whole name, "basis/encoder/evaluator"
};

[[nodiscard]] PictureSet to_pictures(const Comparison& comparison);

/// The HTML that shows `report` (the content of report.json): CSS, scripts and data are all inside, and it loads
/// nothing. Whatever strings the report holds cannot end the element that they are in. Bytes that are not UTF-8 are
/// replaced.
[[nodiscard]] std::string comparison_html(const nlohmann::json& report, const PictureSet& pictures);

}  // namespace lobelia
