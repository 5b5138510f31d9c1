// Mip levels of lightmap pages, in coefficient space.
#pragma once

#include <vector>

#include "core/stop.h"
#include "lobelia/lightmap.h"

namespace lobelia {

/// Makes the levels after a page itself, `count` of them, each half as wide and high; the page's sides must be
/// multiples of 2^count. A texel is the mean of those of the four above it that are valid and belong to one chart, the
/// one with most of them, so that light never runs from chart to chart; texels without any are then filled from their
/// neighbours (dilate). Values are averaged as they are, before they are packed: means of ratios would not be ratios of
/// means. Throws Stopped.
[[nodiscard]] std::vector<LightmapPage> mip_levels(const LightmapPage& page, std::size_t count, StopFlag stop = {});

}  // namespace lobelia
