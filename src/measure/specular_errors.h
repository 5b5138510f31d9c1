// Errors of specular reflection evaluated from coefficients, against the reflection of the environment itself.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/image.h"
#include "lobelia/storage.h"

namespace lobelia {

/// The error of one specular evaluator on the coefficients of a basis, as stored.
struct SpecularError {
    std::string basis, encoder, storage, evaluator;
    double bytes = 0;
    double error = 0;        ///< RMS over points and channels, over the mean reflected radiance
    double nanoseconds = 0;  ///< to evaluate one point
};

struct SpecularErrorOptions {
    std::size_t directions = 384;              ///< seen along the normal, spread over the sphere, for each alpha
    std::vector<float> alphas = {0.1f, 0.3f};  ///< of GGX: roughness 0.32 and 0.55 of glTF
    std::vector<const Storage*> storages;
};

/// Measures every specular evaluator of every spherical basis in every compatible storage; of the encoders, the one
/// with the least error as float32. `environment` is given to encoders texel by texel; the reference is the exact sum
/// over its texels.
[[nodiscard]] std::vector<SpecularError> specular_errors(const Image& environment, const SpecularErrorOptions& options);

}  // namespace lobelia
