// Environments and their samples, as options name them.
#include "cli/environment_input.h"

#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <thread>

#include "cli/common.h"
#include "cli/options.h"
#include "lobelia/sky.h"

namespace lobelia::cli {

void add_environment_options(CLI::App& command, EnvironmentOptions& options) {
    command
        .add_option("ENV", options.path,
                    "A latitude-longitude environment, .hdr or .exr, or \"sky\" for the embedded one")
        ->required();
    command.add_flag("--ldr", options.read.ldr,
                     "Accept PNG, JPEG and WebP too (decoded from sRGB; highlights are clipped)");
    command.add_flag("--sanitize", options.read.sanitize,
                     "Replace NaN, infinite and negative texels by 0 instead of refusing the file");
    command.add_option("--sky-size", options.sky_size, "Size of the embedded sky in texels, WxH")
        ->capture_default_str();
    command.add_option("--sun-elevation", options.sun_elevation, "Sun elevation of the embedded sky in degrees")
        ->check(number_in(1, 90))
        ->capture_default_str();
    command.add_option("--turbidity", options.turbidity, "Turbidity (haze) of the embedded sky")
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
    command
        .add_option_function<std::string>(
            "--sequence", [&](const std::string& name) { options.sequence = sequence_from_name(name); },
            "Sample positions: each texel once (texels), or a point sequence")
        ->check(CLI::IsMember(names))
        ->default_str("texels");
    command.add_option("--samples", options.samples, "Number of samples (default: all texels, or 20000 of a sequence)")
        ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
    command.add_option("--seed", options.seed, "Random seed of the sequence and of the shuffle")
        ->check(CLI::Range(std::uint32_t{0}, ~std::uint32_t{0}))
        ->capture_default_str();
}

}  // namespace lobelia::cli
