// Studies as files.
#include "report/study_page.h"

#include <nlohmann/json.hpp>

#include "io/write_image.h"
#include "report/base64.h"
#include "report/page.h"

namespace lobelia {

nlohmann::json to_json(const Study& study) {
    nlohmann::json tables = nlohmann::json::array(), plots = nlohmann::json::array();
    for (const auto& table : study.tables)
        tables.push_back(
            {{"title", table.title}, {"note", table.note}, {"columns", table.columns}, {"rows", table.rows}});
    const auto axis_name = [](Study::Axis axis) { return axis == Study::Axis::linear ? "linear" : "logarithmic"; };
    for (const auto& plot : study.plots) {
        nlohmann::json series = nlohmann::json::array();
        for (const auto& s : plot.series) series.push_back({{"name", s.name}, {"x", s.x}, {"y", s.y}});
        plots.push_back({{"title", plot.title},
                         {"note", plot.note},
                         {"x_label", plot.x_label},
                         {"y_label", plot.y_label},
                         {"x_axis", axis_name(plot.x_axis)},
                         {"y_axis", axis_name(plot.y_axis)},
                         {"series", std::move(series)}});
    }
    return {{"name", study.name},
            {"title", study.title},
            {"summary", study.summary},
            {"tables", std::move(tables)},
            {"plots", std::move(plots)}};
}

std::string to_markdown(const Study& study) {
    std::string text = "## " + study.title + "\n\n" + study.summary + "\n";
    for (const auto& table : study.tables) (text += '\n') += to_markdown(table);
    return text;
}

Result<std::string> study_html(const Study& study) {
    nlohmann::json data = to_json(study), pictures = nlohmann::json::array();
    for (const auto& picture : study.pictures) {
        const auto png = encode_png(to_srgb(picture.image));
        if (!png) return Error{std::string("picture \"") + picture.title + "\": " + png.error().message};
        pictures.push_back({{"title", picture.title},
                            {"caption", picture.caption},
                            {"width", picture.image.width},
                            {"height", picture.image.height},
                            {"source", "data:image/png;base64," + base64(*png)}});
    }
    data["pictures"] = std::move(pictures);
    data["lobelia"] = LOBELIA_VERSION;
    const std::string text = script_safe(data);
    return filled_page("study.html", text.size(), [&](std::string_view mark, std::string& html) {
        if (mark == "study") html += text;
        return mark == "study";
    });
}

}  // namespace lobelia
