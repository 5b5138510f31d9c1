// What probes see around them, and what invalid ones are given.
#pragma once

#include "core/stop.h"
#include "lobelia/lightmap.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Fills the probes' maps: the mean and the mean square of the distances [m] to surfaces around each texel's direction
/// (weight max(0, cosine)^50, Majercik et al. 2019), none longer than `reach`. Back faces count as nearer, by a fifth
/// of their distance, so that probes inside walls see little.
void measure_visibility(ProbeSet& probes, const PathTracer& tracer, std::size_t side, float reach, StopFlag stop = {});

/// Replaces the coefficients of probes whose validity is below one half by the mean of those of their valid neighbours
/// (along the edges of grid or cells), ring by ring; their validity stays. Where no probe is valid, nothing changes.
void dilate_probes(ProbeSet& probes);

}  // namespace lobelia
