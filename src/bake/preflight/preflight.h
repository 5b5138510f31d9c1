// Preflight of an atlas: problems of its lightmap UVs, and the cost of its bake.
#pragma once

#include "bake/gather/ray_rate.h"
#include "bake/place/atlas.h"
#include "bake/session/setup.h"
#include "io/write_image.h"
#include "lobelia/preflight.h"

namespace lobelia {

/// Returns the memory that a bake needs for states of `state_bytes` per texel and pages of `channels` planes.
[[nodiscard]] BakeMemory bake_memory(const Atlas& atlas, const TexelMap& map, std::size_t state_bytes,
                                     std::size_t channels);

struct PreflightOptions {
    /// Texels required between charts. Bilinear filtering reads one texel beside each chart, and both are filled: 2. A
    /// renderer that reads mips down to level m requires 2^m times as many. (The denoiser stays within charts.)
    std::size_t padding = 2;
    std::size_t state_bytes = 0;  ///< encoder state, per texel
    std::size_t channels = 0;     ///< planes of each page
    std::uint32_t samples = 256;  ///< per texel
    std::optional<RayRate> rate;  ///< absent: no estimate of the time
    StopFlag stop = {};           ///< Stopped is thrown
};
[[nodiscard]] Preflight preflight(const Atlas& atlas, const TexelMap& map, const PreflightOptions& options = {});

/// The same for a bake's setup.
[[nodiscard]] Preflight preflight(const BakeSetup& setup, StopFlag stop = {}, std::optional<RayRate> rate = {});

/// Draws a page: each chart in a colour of its own, overlaps red, texels too close to another chart orange, free texels
/// dark. No side is longer than `most_side`; a pixel of several texels shows the most severe mark.
[[nodiscard]] Image8 preflight_picture(const Preflight& preflight, std::size_t page, std::size_t most_side = 2048);

}  // namespace lobelia
