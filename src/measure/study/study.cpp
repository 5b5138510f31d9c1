// Studies as Markdown and as JSON.
#include "measure/study/study.h"

#include <nlohmann/json.hpp>

namespace lobelia {

std::string to_markdown(const Study::Table& table) {
    const auto line = [](const std::vector<std::string>& cells) {
        std::string text = "|";
        for (const auto& cell : cells) text += " " + cell + " |";
        return text + "\n";
    };
    std::string text = "**" + table.title + "**\n\n" + line(table.columns) + "|";
    for (std::size_t i = 0; i < table.columns.size(); ++i) text += "---|";
    text += "\n";
    for (const auto& row : table.rows) text += line(row);
    if (!table.note.empty()) text += "\n" + table.note + "\n";
    return text;
}

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

}  // namespace lobelia
