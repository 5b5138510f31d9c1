// The report of a comparison as HTML.
#include "report/comparison_report.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "report/page_template.h"

namespace lobelia {
namespace {

void write(const PictureSet& set, std::string& json) {
    json += "{\"references\":";
    char separator = '{';
    for (const auto& [domain, reference] : set.references) {
        (json += separator) += script_safe(domain) + ":{\"radiance\":";
        write_picture(reference.radiance, json);
        json += ",\"irradiance_over_pi\":";
        write_picture(reference.irradiance_over_pi, json);
        json += '}';
        separator = ',';
    }
    json += set.references.empty() ? "{}" : "}";
    json += ",\n\"radiance\":";
    write_pictures(set.radiance, json);
    json += ",\n\"irradiance_over_pi\":";
    write_pictures(set.irradiance_over_pi, json);
    json += '}';
}

std::size_t written_bytes(const PictureSet& set) {
    std::size_t total = lobelia::written_bytes(set.radiance) + lobelia::written_bytes(set.irradiance_over_pi);
    for (const auto& [domain, reference] : set.references)
        total += lobelia::written_bytes(reference.radiance) + lobelia::written_bytes(reference.irradiance_over_pi);
    return total;
}

}  // namespace

PictureSet to_pictures(const Comparison& comparison) {
    const auto encode = [](const Colours& colours, LatLong grid) {
        return encode_picture(colours.view(), grid.width, grid.height);
    };
    PictureSet set;
    const LatLong irradiance_grid = comparison.recipe.empty() ? k_irradiance_picture : comparison.grid;
    for (const auto& [domain, reference] : comparison.pictures.references)
        set.references[std::string(domain_name(domain))] = {encode(reference.radiance, k_measuring_grid),
                                                            encode(reference.irradiance_over_pi, irradiance_grid)};
    for (const auto& [name, picture] : comparison.pictures.radiance)
        set.radiance[name] = encode(picture, k_radiance_picture);
    for (const auto& [name, picture] : comparison.pictures.irradiance_over_pi)
        set.irradiance_over_pi[name] = encode(picture, k_irradiance_picture);
    return set;
}

std::string comparison_html(const nlohmann::json& report, const PictureSet& pictures) {
    const std::string data = script_safe(report);
    return fill_template("comparison/comparison.html", data.size() + written_bytes(pictures),
                         [&](std::string_view mark, std::string& html) {
                             if (mark == "report")
                                 html += data;
                             else if (mark == "pictures")
                                 write(pictures, html);
                             else
                                 return false;
                             return true;
                         });
}

}  // namespace lobelia
