// Light probes: radiance from all directions at points in space, on a regular grid that is refined where interpolation
// between probes differs from the light measured there.
#pragma once

#include "lobelia/bake.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Checks the options. Errors: a codec that is not spherical, too many probes.
[[nodiscard]] Status check(const ProbeOptions& options, const World& world);

/// Places and bakes probes. A probe that sees back faces in more than a sixteenth of all directions is moved out
/// through the nearest of them, through three at most and by half a coarse cell's diagonal; if it still sees them, it
/// is kept with its low validity. The same bits for any number of threads. An early stop is an error.
[[nodiscard]] Result<ProbeSet> bake_probes(const PathTracer& tracer, const ProbeOptions& options,
                                           const BakeSession& session = {});

}  // namespace lobelia
