// Fills the templates of pages.
#include "report/page_template.h"

#include <cassert>
#include <nlohmann/json.hpp>

#include "io/json.h"
#include "report/modules.h"

namespace lobelia {

std::string script_safe(const nlohmann::json& value) {
    const std::string text = json_text(value);
    std::string safe;
    safe.reserve(text.size());
    // `<` occurs in strings only, where \u003c means the same.
    for (const char c : text) {
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    }
    return safe;
}

std::string fill_template(std::string_view page, std::size_t data_bytes,
                          const std::function<bool(std::string_view mark, std::string& html)>& write_data) {
    constexpr std::size_t files_bytes = 512 * 1024;  // Chart.js has 200 KB, all others together less
    const std::string_view text = report_file(page);
    std::string html;
    html.reserve(files_bytes + data_bytes);
    std::size_t position = 0;
    for (;;) {
        const std::size_t open = text.find("{{", position), close = text.find("}}", open);
        html += text.substr(position, open - position);
        if (open == std::string_view::npos || close == std::string_view::npos) return html;
        const std::string_view mark = text.substr(open + 2, close - open - 2), file = report_file(mark);
        const bool is_module = mark.ends_with(".js") && mark.find('/') != std::string_view::npos;
        if (is_module)
            html += joined_modules(mark);
        else
            html += file;
        const bool known = !file.empty() || write_data(mark, html);
        assert(known && "a mark of the template has neither a file nor data");
        static_cast<void>(known);
        position = close + 2;
    }
}

}  // namespace lobelia
