// The HTML report: one file that opens anywhere, offline, with its pictures as half floats inside.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "lobelia/half.h"
#include "lobelia/planes.h"

namespace lobelia {

/// A picture as the page takes it: base64 of little-endian float16 R, G, B, row by row; 8 characters for a pixel.
struct Picture {
    std::size_t width = 0;
    std::size_t height = 0;
    std::string base64_half;
};

/// Encodes linear pixels, row by row from the top left. Precondition: as many pixels as `width` x `height`.
[[nodiscard]] Picture encode_picture(std::span<const Rgb> pixels, std::size_t width, std::size_t height);
[[nodiscard]] Picture encode_picture(const ColourView& pixels, std::size_t width, std::size_t height);

/// All pictures of a report, latitude-longitude, linear: radiance [W/(m^2 sr)] and irradiance over pi [W/(m^2 sr)].
/// A picture may be any size, and may be missing: the page then leaves its place empty.
struct PictureSet {
    struct Reference {
        Picture radiance;
        Picture irradiance_over_pi;
    };
    std::map<std::string, Reference> references;        // by domain: "sphere", "hemisphere"
    std::map<std::string, Picture> radiance;            // by "basis/encoder": before any evaluator cuts it
    std::map<std::string, Picture> irradiance_over_pi;  // by the method's whole name, "basis/encoder/evaluator"
};

/// The page that shows `report` (the content of report.json): CSS, scripts and data are all inside, and it loads
/// nothing. Whatever strings the report holds cannot end the element that they are in. Bytes that are not UTF-8 are
/// replaced.
[[nodiscard]] std::string report_html(const nlohmann::json& report, const PictureSet& pictures);

}  // namespace lobelia
