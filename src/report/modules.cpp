// Follows imports depth first.
#include "report/modules.h"

#include <cassert>
#include <filesystem>
#include <set>

#include "report/page_template.h"

namespace lobelia {
namespace {

constexpr std::string_view k_import = "import {", k_from = "from \"", k_export = "export ";

/// The path of `imported` as the module at `importer` names it, from the folder of all modules.
std::string resolved(std::string_view importer, std::string_view imported) {
    const auto folder = std::filesystem::path(importer).parent_path();
    return (folder / std::filesystem::path(imported)).lexically_normal().generic_string();
}

class Joiner {
  public:
    void add(const std::string& path) {
        if (!added_.insert(path).second) return;
        std::string_view text = report_file(path);
        assert(!text.empty() && "a module that is not embedded");
        std::string body;
        while (!text.empty()) {
            if (text.starts_with(k_import)) {
                const std::size_t from = text.find(k_from) + k_from.size(), end = text.find('"', from);
                add(resolved(path, text.substr(from, end - from)));
                skip_line(text, end);
                continue;
            }
            if (text.starts_with(k_export)) text.remove_prefix(k_export.size());
            const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
            body += text.substr(0, end);
            text.remove_prefix(end);
        }
        joined_ += body;
    }
    [[nodiscard]] std::string text() && { return std::move(joined_); }

  private:
    /// Removes all up to the end of the line that holds the character at `position`.
    static void skip_line(std::string_view& text, std::size_t position) {
        text.remove_prefix(std::min(text.find('\n', position), text.size() - 1) + 1);
    }

    std::set<std::string> added_;
    std::string joined_;
};

}  // namespace

std::string joined_modules(std::string_view entry) {
    Joiner joiner;
    joiner.add(std::string(entry));
    return std::move(joiner).text();
}

}  // namespace lobelia
