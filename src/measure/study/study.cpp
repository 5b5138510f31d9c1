// Tables of studies as text.
#include "measure/study/study.h"

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

}  // namespace lobelia
