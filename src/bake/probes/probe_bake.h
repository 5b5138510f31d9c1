// Light probes: points in the room that hold the radiance from all around, on a regular grid that is refined where the
// light between probes is not what they would say of it.
#pragma once

#include <optional>

#include "bake/baker.h"
#include "bake/probes/probes.h"

namespace lobelia {

struct ProbeOptions {
    double spacing = 0;                      ///< of the coarsest grid [m]; 0: no probes
    std::optional<std::array<Vec3, 2>> box;  ///< lowest and highest corner; none: the box around the scene
    std::string codec = default_codec();
    int levels = 0;                      ///< how often a cell may be divided in eight
    double tolerance = 0.15;             ///< a cell is divided where the irradiance in its middle is off by this share
    std::uint32_t samples = 1024;        ///< for each probe
    std::size_t most_probes = 1u << 20;  ///< more are an error
};

/// An error where the codec does not suit or there would be too many probes.
[[nodiscard]] Status check(const ProbeOptions& options, const World& world);

/// Places and bakes them. A probe that sees back faces in more than a sixteenth of all directions is moved out through
/// the nearest of them, through three at most and by half a coarse cell's diagonal; one that still does is kept with
/// its low validity. Deterministic at any thread count.
[[nodiscard]] Result<ProbeSet> bake_probes(const PathTracer& tracer, const ProbeOptions& options, unsigned threads,
                                           const std::atomic<bool>& stop, const BakeProgressSink& progress = {});

}  // namespace lobelia
