// Shared by all reports: embedded files, templates with placeholders, and JSON inside script elements.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace lobelia {

/// The bytes of an embedded file of this folder, or of Chart.js as "chart.js"; empty where there is none.
[[nodiscard]] std::string_view report_file(std::string_view name);

/// JSON text that cannot end the script element it stands in. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string script_safe(const nlohmann::json& value);

/// The embedded `page` with each {{mark}} replaced: by the embedded file of that name (a module with all its
/// imports, see modules.h), or else by what `write_data` appends. The replacement is not searched for further marks.
/// Precondition: `write_data` knows every other mark, and returns whether it does.
/// `data_bytes`: about how much it appends in all, so that a page of many megabytes is not copied while it grows.
[[nodiscard]] std::string fill_template(
    std::string_view page, std::size_t data_bytes,
    const std::function<bool(std::string_view mark, std::string& html)>& write_data);

}  // namespace lobelia
