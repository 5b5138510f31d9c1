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

/// Returns the texels that textures of this many mip levels require between charts, for bilinear filtering reads one
/// texel beside each chart, and both are to be filled from it: two whole free texels of the smallest level, wherever
/// its grid lies. (The denoiser stays within charts.)
[[nodiscard]] constexpr std::size_t padding_for_levels(std::uint32_t levels) {
    return (std::size_t{3} << (levels - 1)) - 1;
}

struct PreflightOptions {
    std::size_t padding = padding_for_levels(1);  ///< texels required between charts
    std::size_t state_bytes = 0;                  ///< encoder state, per texel
    std::size_t channels = 0;                     ///< planes of each page
    std::uint32_t samples = 256;                  ///< per texel
    std::optional<RayRate> rate;                  ///< absent: no estimate of the time
    StopFlag stop = {};                           ///< Stopped is thrown
};
[[nodiscard]] Preflight preflight(const Atlas& atlas, const TexelMap& map, const PreflightOptions& options = {});

/// The same for a bake's setup.
[[nodiscard]] Preflight preflight(const BakeSetup& setup, std::uint32_t mip_levels, StopFlag stop = {},
                                  std::optional<RayRate> rate = {});

/// Draws a page: each chart in a colour of its own, overlaps red, texels too close to another chart orange, free texels
/// dark. No side is longer than `most_side`; a pixel of several texels shows the most severe mark.
[[nodiscard]] Image8 preflight_picture(const Preflight& preflight, std::size_t page, std::size_t most_side = 2048);

}  // namespace lobelia
