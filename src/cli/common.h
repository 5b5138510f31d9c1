// What several verbs share: the environment argument, grid sizes, progress, output.
#pragma once

#include <CLI/CLI.hpp>

#include "io/folders.h"
#include "io/read_file.h"
#include "io/read_image.h"
#include "io/write_file.h"
#include "measure/comparison.h"
#include "report/json.h"

namespace lobelia::cli {

/// The options that name and read an environment.
struct EnvironmentOptions {
    std::string path;
    ReadOptions read;
    std::string sky_size = "512x256";
    double sun_elevation = 40;
    double turbidity = 3;
};

void add_environment_options(CLI::App& command, EnvironmentOptions& options);

/// An environment and what to say of it.
struct LoadedEnvironment {
    Image image;
    EnvironmentInfo info;
};

/// Reads the file, or makes the sky. Warnings go to stderr.
[[nodiscard]] Result<LoadedEnvironment> load(const EnvironmentOptions& options);

/// How samples are taken of it.
struct SamplingOptions {
    std::string sequence = "texels";
    std::optional<std::size_t> samples;
    std::uint32_t seed = 1;
};

void add_sampling_options(CLI::App& command, SamplingOptions& options);

/// The same as the comparison takes it.
[[nodiscard]] ComparisonOptions comparison_options(const SamplingOptions& options);

/// A check that a number lies in [low, high]; unlike CLI::Range it refuses NaN.
[[nodiscard]] CLI::Validator number_in(double low, double high);

/// "256x128" as a grid of at least 1 x 1 and at most 2^26 texels.
[[nodiscard]] Result<LatLong> parse_grid(const std::string& text);

/// A line on stderr; where nobody listens any more, it is lost and nothing else changes.
void complain(const std::string& line);

/// A bar on stderr for work that lasts over a second, only where stderr is a terminal; else null.
[[nodiscard]] Progress progress_bar();
/// The same with a text behind the bar.
using LabelledProgress = std::function<void(double, std::string_view)>;
[[nodiscard]] LabelledProgress labelled_progress_bar();

}  // namespace lobelia::cli
