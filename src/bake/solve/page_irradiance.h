// Irradiance of a whole page, read from its coefficients.
#pragma once

#include <span>
#include <vector>

#include "lobelia/bake_job.h"
#include "lobelia/lightmap.h"

namespace lobelia {

/// E [W/m^2] at each texel's shading normal, as the evaluator means it. `normals` are of each texel, in the world;
/// where there is none (zero), E is 0. In Frame::tangent the coefficients' z axis is that normal.
[[nodiscard]] std::vector<Rgb> page_irradiance(const LightmapPage& page, const PageChannels& channels,
                                               std::span<const Vec3> normals, Frame frame, const Evaluator& evaluator);

}  // namespace lobelia
