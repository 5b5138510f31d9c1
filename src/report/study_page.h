// Studies as files: a page that opens offline, JSON, and Markdown.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lobelia/result.h"
#include "lobelia/study.h"

namespace lobelia {

[[nodiscard]] nlohmann::json to_json(const Study& study);

/// All tables as Markdown.
[[nodiscard]] std::string to_markdown(const Study& study);

/// One HTML file with tables, plots (Chart.js inside) and pictures (PNG inside); it loads nothing.
[[nodiscard]] Result<std::string> study_html(const Study& study);

}  // namespace lobelia
