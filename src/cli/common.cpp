// Grid sizes, output, progress.
#include "cli/common.h"

#include <fmt/core.h>
#include <unistd.h>

#include <charconv>
#include <chrono>


namespace lobelia::cli {

Result<LatLong> parse_grid(const std::string& text) {
    const Error error{"\"" + text + "\" is not a size such as 256x128 (at most 2^26 texels)"};
    LatLong grid;
    const char* end = text.data() + text.size();
    auto [x, width_error] = std::from_chars(text.data(), end, grid.width);
    if (width_error != std::errc() || x == end || *x != 'x') return error;
    auto [rest, height_error] = std::from_chars(x + 1, end, grid.height);
    constexpr std::size_t most = std::size_t{1} << 26;
    if (height_error != std::errc() || rest != end || grid.width < 1 || grid.height < 1 || grid.width > most ||
        grid.height > most || grid.size() > most)
        return error;
    return grid;
}

Status check_folder(const std::filesystem::path& folder) {
    // Ask the folder, or the nearest one above it that is there.
    namespace fs = std::filesystem;
    std::error_code code;
    fs::path existing = fs::absolute(folder, code);
    while (!fs::exists(existing, code) && existing.has_relative_path()) existing = existing.parent_path();
    if (!fs::is_directory(existing, code))
        return Error{folder.string() + ": cannot be made a folder: " + existing.string() + " is not one"};
    if (access(existing.c_str(), W_OK | X_OK) != 0)
        return Error{folder.string() + ": cannot be written to: " + std::generic_category().message(errno)};
    return Done{};
}

Status check_file(const std::filesystem::path& file) {
    namespace fs = std::filesystem;
    std::error_code code;
    const fs::path folder = fs::absolute(file, code).parent_path();
    if (!fs::is_directory(folder, code))
        return Error{file.string() + ": cannot be written: there is no folder " + folder.string()};
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{file.string() + ": cannot be written: " + std::generic_category().message(errno)};
    return Done{};
}

Status write_into_folder(const std::filesystem::path& folder, std::span<const FileContent> files) {
    // Find the topmost folder that is made here, to remove it again if the files cannot be written.
    namespace fs = std::filesystem;
    std::error_code code;
    fs::path made;
    for (fs::path at = fs::absolute(folder, code); !at.empty() && !fs::exists(at, code) && at.has_relative_path();
         at = at.parent_path())
        made = at;
    fs::create_directories(folder, code);
    auto status = code ? Status(Error{folder.string() + ": cannot be made a folder: " + code.message()})
                       : write_files_together(files);
    if (!status && !made.empty()) {
        // Remove empty folders only, from the innermost out.
        for (fs::path at = fs::absolute(folder, code); at != made.parent_path() && fs::remove(at, code);
             at = at.parent_path()) {
        }
    }
    return status;
}

void complain(const std::string& line) {
    std::fputs((line + "\n").c_str(), stderr);
    std::fflush(stderr);
}

LabelledProgress labelled_progress_bar() {
    if (isatty(STDERR_FILENO) == 0) return {};
    const auto start = std::chrono::steady_clock::now();
    return [start, shown = false](double done, std::string_view text) mutable {
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (seconds < 1 || (done >= 1 && !shown)) return;
        constexpr int width = 40;
        const int filled = static_cast<int>(done * width);
        std::string line =
            fmt::format("\r[{:=<{}}{: <{}}] {:3.0f} % {}\033[K", "", filled, "", width - filled, 100 * done, text);
        if (done >= 1 - 1e-9) line += "\r\033[K";
        std::fputs(line.c_str(), stderr);
        std::fflush(stderr);
        shown = true;
    };
}

Progress progress_bar() {
    auto bar = labelled_progress_bar();
    if (!bar) return {};
    return [bar](double done) { bar(done, ""); };
}

}  // namespace lobelia::cli
