// How far gloss that is read from coefficients is from the gloss of the environment itself.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/image.h"
#include "lobelia/storage.h"

namespace lobelia {

/// A codec without its evaluator of irradiance, read as glossy reflection.
struct GlossError {
    std::string basis, encoder, storage, reading;
    double bytes = 0;
    double error = 0;        ///< RMS over points and channels, over the mean reflected radiance
    double nanoseconds = 0;  ///< to read one point
};

struct GlossOptions {
    std::size_t directions = 384;              ///< seen along the normal, spread over the sphere, for each alpha
    std::vector<float> alphas = {0.1f, 0.3f};  ///< of GGX: roughness 0.32 and 0.55 of glTF
    std::vector<const Storage*> storages;
};

/// Every reading of every basis over the sphere, in every storage that suits it; of its encoders the one that reads
/// best as float32. `environment` is given to encoders texel by texel, and the truth is the exact sum over its texels.
[[nodiscard]] std::vector<GlossError> gloss_errors(const Image& environment, const GlossOptions& options);

}  // namespace lobelia
