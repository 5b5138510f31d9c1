// Numbers and tables of studies as text.
#include "lobelia/study.h"

#include <cmath>
#include <cstdio>

namespace lobelia {

std::string table_number(double value, int digits) {
    char text[32];
    if (value != 0 && std::abs(value) < 1e-2) {
        // Drop the exponent's padding: 3.1e-04 reads as 3.1e-4.
        std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
        std::string shortened = text;
        const auto e = shortened.find('e');
        if (e != std::string::npos && shortened.size() > e + 3 && shortened[e + 2] == '0') shortened.erase(e + 2, 1);
        return shortened;
    }
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

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
