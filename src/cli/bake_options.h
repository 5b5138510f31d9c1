// The options of lobelia bake, and the job that they describe.
#pragma once

#include <string>
#include <vector>

#include "lobelia/bake.h"

namespace CLI {
class App;
}

namespace lobelia::cli {

/// Options as they are typed.
struct BakeArguments {
    BakeJob job;
    ProbeOptions probes;
    std::optional<double> probe_spacing;
    std::string out;
    std::string size = "512x512", picture_size = "640x400", memory = "2G";
    std::string frame = "world", directions = "uniform", layout = "automatic", precision = "half", shard_by = "tiles";
    std::string shard, probe_box, rebake_object;
    std::vector<std::string> storages, exports;
    std::uint32_t add_samples = 0;
    bool resume = false, plain = false, preflight = false;
    bool no_denoise = false, no_seams = false, no_dilate = false, no_push_out = false, no_report = false;
    bool no_arrays = false, zstd = false;
    bool no_next_event = false, no_roulette = false;
};

void add_bake_options(CLI::App& command, BakeArguments& arguments);

/// Checks what CLI11 does not, and makes the job.
[[nodiscard]] Result<BakeJob> job_of(const BakeArguments& arguments);

}  // namespace lobelia::cli
