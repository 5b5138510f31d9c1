// Directions and output file of lobelia eval and lobelia reference.
#pragma once

#include <string>

#include "lobelia/basis.h"
#include "lobelia/environment.h"
#include "lobelia/result.h"

namespace CLI {
class App;
}

namespace lobelia::cli {

struct EvaluationOptions {
    std::string normals;
    std::string lat_long;
    std::string out;
    bool radiance = false;
    double exposure = 0;
};

void add_evaluation_options(CLI::App& command, EvaluationOptions& options);

/// Directions in the frame of a domain: those of a grid, or a list as one row.
struct Target {
    LatLong grid;
    Directions directions;
};
[[nodiscard]] Result<Target> target_of(const EvaluationOptions& options, Domain domain);

/// Writes one value for each direction, as .csv, .exr or .png.
[[nodiscard]] Status write_values(const EvaluationOptions& options, const Target& target, const Colours& values);

}  // namespace lobelia::cli
