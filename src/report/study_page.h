// Studies as files: a page that opens offline, JSON, and Markdown.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lobelia/result.h"
#include "measure/study/study.h"

namespace lobelia {

/// All but the pictures.
[[nodiscard]] nlohmann::json to_json(const Study& study);

/// All tables as Markdown.
[[nodiscard]] std::string to_markdown(const Study& study);

/// One HTML file with tables, plots (Chart.js inside) and pictures (PNG inside); it loads nothing. Whatever strings the
/// study holds cannot end the element that they are in. Error: a picture without pixels.
[[nodiscard]] Result<std::string> study_html(const Study& study);

}  // namespace lobelia
