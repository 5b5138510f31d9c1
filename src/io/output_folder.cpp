// Folders made for outputs, which disappear again if nothing is written into them.
#include "io/output_folder.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace lobelia {

namespace fs = std::filesystem;

Result<OutputFolder> OutputFolder::make(const fs::path& path) {
    OutputFolder folder(path);
    std::error_code code;
    const auto failed = [&](const std::error_code& reason) {
        return Error{fmt::format("{}: cannot be made a folder: {}", path.string(), reason.message())};
    };

    // List the missing folders, innermost first. A path may end in a slash.
    std::vector<fs::path> missing;
    fs::path next = path.has_filename() ? path : path.parent_path();
    while (!next.empty() && !fs::exists(next, code)) {
        missing.push_back(next);
        next = next.parent_path();
    }

    // Create them, outermost first; another process may be faster.
    for (auto created = missing.rbegin(); created != missing.rend(); ++created) {
        if (fs::create_directory(*created, code)) folder.created_.push_back(*created);
        if (code) return failed(code);
    }
    if (!fs::is_directory(path.empty() ? fs::path(".") : path, code))
        return failed(code ? code : std::make_error_code(std::errc::not_a_directory));
    return folder;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)), created_(std::exchange(other.created_, {})) {}

OutputFolder::~OutputFolder() {
    std::error_code ignored;
    while (!created_.empty()) {
        fs::remove(created_.back(), ignored);
        created_.pop_back();
    }
}

}  // namespace lobelia
