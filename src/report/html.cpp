// The report as a page.
#include "report/html.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "report/page.h"

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

std::string report_html(const nlohmann::json& report, const PictureSet& pictures) {
    const std::string data = script_safe(report);
    return filled_page("report.html", data.size() + written_bytes(pictures),
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
