// Occluders that stand on seams, such as walls: light differs on their two sides, and the seam under them must stay
// open.
#pragma once

#include "bake/finish/find_seams.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// Returns whether any surface stands on the seam at the fraction `s` of its length. Two rays a little above the
/// surface look for one: each starts a texel's width inside one triangle and ends just beyond the edge.
[[nodiscard]] bool is_walled(const PathTracer& tracer, const Atlas& atlas, const Seam& seam, float s);

}  // namespace lobelia
