// Measures how fast this machine traces a scene: a short trial.
#pragma once

#include "bake/gather/gather.h"
#include "bake/place/atlas.h"

namespace lobelia {

struct RayRate {
    double rays_per_second = 0;
    double rays_per_sample = 0;
};

/// Traces a few samples from texels all over the atlas, on all threads, for about a quarter of a second.
[[nodiscard]] RayRate measure_rate(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer,
                                   const GatherOptions& options = {});

}  // namespace lobelia
