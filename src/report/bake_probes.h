// Probes as small spheres lit by their coefficients: one plan for each height.
#pragma once

#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/image.h"
#include "lobelia/lightmap.h"

namespace lobelia {

/// The probes of one height, seen from above: x to the right, z down the page. Every pixel of a sphere shows E / pi
/// [W/(m^2 sr)] at its normal there.
struct ProbePlan {
    enum Mark : std::uint16_t { k_nothing, k_valid, k_invalid };
    double height = 0;  ///< y [m]
    std::size_t count = 0;
    Image image;
    std::vector<std::uint16_t> marks;  ///< a Mark for each pixel
};

/// A set of probes as the report shows it.
struct ProbeView {
    std::string codec;
    std::size_t count = 0, invalid = 0;  ///< in all; those with a validity below one half
    std::size_t heights = 0;             ///< in all; some of them have plans
    std::vector<ProbePlan> plans;        ///< from the lowest up
};

struct ProbeViewOptions {
    std::size_t most_side = 256;  ///< of a plan [pixels]
    std::size_t most_plans = 12;  ///< if there are more heights, these many are chosen evenly
};

/// Probes stand where the grid or the cells have them, though they may have been pushed out from there.
[[nodiscard]] ProbeView view_probes(const ProbeSet& probes, const Codec& codec, const ProbeViewOptions& options = {});

}  // namespace lobelia
