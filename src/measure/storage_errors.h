// What storages cost: a codec's coefficients packed, unpacked and judged again.
#pragma once

#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/storage.h"

namespace lobelia {

/// A codec's coefficients in one storage. Errors of coefficients are shares of the largest magnitude of any.
struct StorageErrors {
    std::string storage;
    double bytes = 0;  ///< for one texel of a page
    double radiance_rms = 0, irradiance_over_pi_rms = 0;
    double largest_error = 0;  ///< of a coefficient
    double bound = 0;          ///< the largest error that the storage's bound allows any of them
    double bound_used = 0;     ///< the largest share of what it allows that any of them uses: at most 1
    std::size_t cut = 0;       ///< values beyond the storage's limits, of which its bound says nothing
};

/// One entry for each of the storages that suits the codec. `judged` holds directions, radiance and weights;
/// `reference` is the irradiance over pi at the same directions.
[[nodiscard]] std::vector<StorageErrors> storage_errors(const Codec& codec, std::span<const Rgb> c,
                                                        std::span<const Storage* const> storages, SampleView judged,
                                                        ColourView reference);

}  // namespace lobelia
