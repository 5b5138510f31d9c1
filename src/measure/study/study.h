// The form of every study: tables, plots and pictures with captions, so that any page can show any of them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/math/number_text.h"
#include "lobelia/image.h"

namespace lobelia {

struct Study {
    struct Table {
        std::string title, note;
        std::vector<std::string> columns;
        std::vector<std::vector<std::string>> rows;
    };
    struct Series {
        std::string name;
        std::vector<double> x, y;
    };
    enum class Axis { linear, logarithmic };
    struct Plot {
        std::string title, note, x_label, y_label;
        Axis x_axis = Axis::linear, y_axis = Axis::linear;
        std::vector<Series> series;
    };
    struct Picture {
        std::string title, caption;
        Image image;  ///< linear, to be shown as it is
    };

    std::string name;  ///< for file names
    std::string title, summary;
    std::vector<Table> tables;
    std::vector<Plot> plots;
    std::vector<Picture> pictures;
};

/// A table, or all tables of a study, as Markdown.
[[nodiscard]] std::string to_markdown(const Study::Table& table);
[[nodiscard]] std::string to_markdown(const Study& study);

/// All but the pictures.
[[nodiscard]] nlohmann::json to_json(const Study& study);

}  // namespace lobelia
