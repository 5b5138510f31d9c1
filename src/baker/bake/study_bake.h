// How far each codec's irradiance is from the truth at the texels of a scene, all codecs fed the same samples.
#pragma once

#include <atomic>
#include <functional>

#include "baker/bake/bake.h"
#include "lobelia/study.h"

namespace lobelia {

struct BakeStudyOptions {
    std::size_t texels = 1000;                ///< chosen evenly from the atlas
    std::uint32_t samples = 256;              ///< for each codec; a multiple of 64
    std::uint32_t reference_samples = 16384;  ///< whose irradiance is taken as true; more of the same sequence
    std::vector<std::string> bases;           ///< empty: all of the list
};

/// A row for each basis and encoder under its best evaluator of irradiance, ordered by error. Irradiance is compared at
/// the shading normal and at normals all around it, as a normal map would tilt it; errors are RMS over texels, divided
/// by the mean irradiance.
[[nodiscard]] Result<Study> study_bake(const Scene& scene, const BakeOptions& bake, const BakeStudyOptions& options,
                                       const std::atomic<bool>& stop, const std::function<void(double)>& progress = {});

}  // namespace lobelia
