// The environment argument that several verbs share, and how it is sampled.
#pragma once

#include <string>

#include "coefficients/encode.h"
#include "io/read_image.h"
#include "measure/comparison_json.h"

namespace CLI {
class App;
}

namespace lobelia::cli {

/// Options that name an environment and how to read it.
struct EnvironmentOptions {
    std::string path;
    ReadOptions read;
    std::string sky_size = "512x256";
    double sun_elevation = 40;
    double turbidity = 3;
};

void add_environment_options(CLI::App& command, EnvironmentOptions& options);

/// An environment and where it came from.
struct LoadedEnvironment {
    Image image;
    EnvironmentInfo info;
};

/// Reads the file, or makes the sky. Warnings go to stderr.
[[nodiscard]] Result<LoadedEnvironment> load(const EnvironmentOptions& options);

/// Adds --sequence, --samples and --seed.
void add_sampling_options(CLI::App& command, SamplingOptions& options);

}  // namespace lobelia::cli
