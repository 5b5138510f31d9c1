// Ranges of a job's options.
#include "bake/check_job.h"

#include <fmt/format.h>

#include "lobelia/planes.h"

namespace lobelia {
namespace {

/// An error unless low <= value <= high; NaN is outside.
Status in_range(const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return Done{};
    return Error{fmt::format("{} = {:g} is out of range: {:g} to {:g}", name, value, low, high)};
}

}  // namespace

Status check(const BakeJob& job) {
    const BakeOptions& bake = job.bake;
    struct Range {
        const char* name;
        double value, low, high;
    };
    const ProbeOptions probes = job.probes.value_or(ProbeOptions{});
    for (const auto& [name, value, low, high] : {
             Range{"width", static_cast<double>(bake.atlas.width), 1, 16384},
             Range{"height", static_cast<double>(bake.atlas.height), 1, 16384},
             Range{"texels per metre", bake.atlas.texels_per_metre.value_or(1), 0.01, 10000},
             Range{"padding", static_cast<double>(bake.atlas.padding), 0, 64},
             Range{"samples", static_cast<double>(bake.samples), 1, 1e6},
             Range{"bounces", static_cast<double>(bake.paths.bounces), 0, 64},
             Range{"threads", static_cast<double>(bake.threads), 0, 1024},
             Range{"memory", static_cast<double>(bake.memory), 1 << 20, 1e15},
             Range{"time", bake.most_seconds.value_or(1), 0.1, 1e7},
             Range{"target error", bake.target_error.value_or(1), 1e-4, 1},
             Range{"probe spacing", probes.spacing, 0.001, 10000},
             Range{"probe levels", static_cast<double>(probes.levels), 0, 6},
             Range{"probe samples", static_cast<double>(probes.samples), 64, 1e6},
         })
        if (auto status = in_range(name, value, low, high); !status) return status;
    if (bake.samples_per_pass == 0 || bake.samples_per_pass % k_lanes != 0)
        return Error{fmt::format("samples per pass = {} is not a multiple of {}", bake.samples_per_pass, k_lanes)};
    if (bake.shard.count == 0 || bake.shard.index >= bake.shard.count)
        return Error{
            fmt::format("shard {} of {} does not exist: they are counted from 0", bake.shard.index, bake.shard.count)};
    return Done{};
}

}  // namespace lobelia
