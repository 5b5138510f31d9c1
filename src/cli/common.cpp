// What several verbs share.
#include "cli/common.h"

#include <fmt/core.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <thread>

#include "lobelia/sky.h"

namespace lobelia::cli {

void add_environment_options(CLI::App& command, EnvironmentOptions& options) {
    command
        .add_option("ENV", options.path,
                    "A latitude-longitude environment, .hdr or .exr, or \"sky\" for the embedded one")
        ->required();
    command.add_flag("--ldr", options.read.ldr,
                     "Accept PNG, JPEG and WebP too (decoded from sRGB; highlights are cut off)");
    command.add_flag("--sanitize", options.read.sanitize,
                     "Replace NaN, infinite and negative texels by 0 where they are otherwise refused");
    command.add_option("--sky-size", options.sky_size, "Texels of the embedded sky, WxH")->capture_default_str();
    command.add_option("--sun-elevation", options.sun_elevation, "Of the embedded sky [degrees]")
        ->check(number_in(1, 90))
        ->capture_default_str();
    command.add_option("--turbidity", options.turbidity, "Haze of the embedded sky")
        ->check(number_in(2, 10))
        ->capture_default_str();
}

Result<LoadedEnvironment> load(const EnvironmentOptions& options) {
    if (options.path == "sky") {
        auto grid = parse_grid(options.sky_size);
        if (!grid) return Error{"--sky-size: " + grid.error().message};
        SkyOptions sky_options;
        sky_options.sun_elevation = options.sun_elevation;
        sky_options.turbidity = options.turbidity;
        if (const auto status = check(sky_options); !status) return status.error();
        return LoadedEnvironment{sky(*grid, sky_options), {"sky", *grid, {}, 0}};
    }
    allow_reader_threads(static_cast<int>(std::thread::hardware_concurrency()));
    auto loaded = read_environment(options.path, options.read);
    if (!loaded) return loaded.error();
    for (const auto& warning : loaded->warnings) complain("lobelia: warning: " + options.path + ": " + warning);
    EnvironmentInfo info{std::filesystem::path(options.path).filename().string(), lat_long(loaded->image),
                         loaded->warnings, loaded->sanitized.total()};
    return LoadedEnvironment{std::move(loaded->image), std::move(info)};
}

void add_sampling_options(CLI::App& command, SamplingOptions& options) {
    std::vector<std::string> names = {"texels"};
    for (Sequence sequence : k_sequences) names.emplace_back(sequence_name(sequence));
    command.add_option("--sequence", options.sequence, "Where samples are taken; texels: each one once, shuffled")
        ->check(CLI::IsMember(names))
        ->capture_default_str();
    command
        .add_option("--samples", options.samples,
                    "How many, 1 to 100000000 (default: all texels, or 20000 of another sequence)")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    command.add_option("--seed", options.seed, "Of the sequence and the shuffle, 0 to 4294967295")
        ->capture_default_str();
}

ComparisonOptions comparison_options(const SamplingOptions& options) {
    ComparisonOptions comparison;
    comparison.sequence = sequence_from_name(options.sequence);
    comparison.samples = options.samples;
    comparison.seed = options.seed;
    return comparison;
}

CLI::Validator number_in(double low, double high) {
    const auto check = [low, high](const std::string& text) {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
        return good ? std::string() : fmt::format("{} is not a number from {} to {}", text, low, high);
    };
    return CLI::Validator(check, fmt::format("FLOAT in [{} - {}]", low, high));
}

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
