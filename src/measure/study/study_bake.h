// Errors of each codec's irradiance at the texels of a scene; all codecs receive the same samples.
#pragma once

#include <atomic>
#include <functional>

#include "bake/session/setup.h"
#include "lobelia/storage.h"
#include "measure/study/study.h"

namespace lobelia {

struct BakeStudyOptions {
    std::size_t texels = 1000;                  ///< chosen evenly from the atlas; with storages, 4 x 4 side by side
    std::uint32_t samples = 256;                ///< for each codec; a multiple of 64
    std::uint32_t reference_samples = 16384;    ///< for the reference; more of the same sequence
    std::vector<std::string> bases;             ///< empty: all of the list
    std::vector<const Storage*> storages = {};  ///< to store and measure coefficients in, too
};

/// A codec on all texels. Irradiance is compared at the shading normal and at normals all around it, as a normal map
/// tilts them; errors are RMS over texels, divided by the mean irradiance.
struct BakedCodec {
    CodecName name;
    const Storage* storage = nullptr;  ///< null: as solved
    double bytes = 0;                  ///< for a texel
    double at_normal = 0, tilted = 0;
    double negative_share = 0;
};
struct BakedCodecs {
    std::size_t texels = 0;          ///< valid and lit ones
    std::vector<BakedCodec> codecs;  ///< every basis, encoder, storage and evaluator
};
[[nodiscard]] Result<BakedCodecs> measure_baked_codecs(const Scene& scene, const BakeOptions& bake,
                                                       const BakeStudyOptions& options, const std::atomic<bool>& stop,
                                                       const std::function<void(double)>& progress = {});

/// The same as a table: a row for each basis and encoder under its best evaluator, ordered by error; as solved.
[[nodiscard]] Result<Study> study_bake(const Scene& scene, const BakeOptions& bake, const BakeStudyOptions& options,
                                       const std::atomic<bool>& stop, const std::function<void(double)>& progress = {});

}  // namespace lobelia
