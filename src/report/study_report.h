// The report of a study: tables, plots and pictures in one HTML file that opens offline.
#pragma once

#include <string>

#include "lobelia/result.h"
#include "measure/study/study.h"

namespace lobelia {

/// The HTML, with Chart.js and PNG pictures inside; it loads nothing. Whatever strings the study holds cannot end the
/// element that they are in. Error: a picture without pixels.
[[nodiscard]] Result<std::string> study_html(const Study& study);

}  // namespace lobelia
