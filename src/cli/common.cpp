// Grid sizes, progress.
#include "cli/common.h"

#include <fmt/core.h>
#include <unistd.h>

#include <charconv>
#include <chrono>

#include "bake/check_job.h"
#include "io/printable.h"

namespace lobelia::cli {

Result<LatLong> parse_grid(const std::string& text) {
    const Error error{"\"" + text + "\" is not a size such as 256x128 (at most 67108864 texels)"};
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

Result<std::size_t> parse_bytes(std::string_view option, const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, code] = std::from_chars(text.data(), end, value);
    const std::string unit(rest, end);
    const double factor = unit.empty() ? 1 : unit == "M" ? 1 << 20 : unit == "G" ? 1 << 30 : 0;
    const auto [least, most] = ranges::memory;
    if (code != std::errc() || factor == 0 || !(value * factor >= least) || !(value * factor <= most))
        return Error{fmt::format("{}: \"{}\" is not an amount such as 512M or 4G (64M at least)", option, text)};
    return static_cast<std::size_t>(value * factor);
}

LabelledProgress labelled_progress_bar() {
    if (isatty(STDERR_FILENO) == 0) return {};
    const auto start = std::chrono::steady_clock::now();
    return [start, shown = false](double done, std::string_view text) mutable {
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (seconds < 1 || (done >= 1 && !shown)) return;
        constexpr int width = 40;
        const int filled = static_cast<int>(done * width);
        std::string line = fmt::format("\r[{:=<{}}{: <{}}] {:3.0f} % {}\033[K", "", filled, "", width - filled,
                                       100 * done, printable(text));
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
