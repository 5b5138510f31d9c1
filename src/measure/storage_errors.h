// Errors of storages: the coefficients of a codec packed, unpacked and measured again.
#pragma once

#include <string>
#include <vector>

#include "lobelia/codec.h"
#include "lobelia/storage.h"

namespace lobelia {

/// A codec's coefficients in one storage. Errors of coefficients are relative to the largest magnitude.
struct StorageErrors {
    std::string storage;
    double bytes = 0;  ///< for one texel of a page
    double radiance_rms = 0, irradiance_over_pi_rms = 0;
    double largest_error = 0;  ///< of a coefficient
    double bound = 0;          ///< largest error that the storage's bound allows
    double bound_used = 0;     ///< largest error as a share of its bound: at most 1
    std::size_t cut = 0;       ///< number of values beyond the limits of the storage, for which there is no bound
};

/// Measures the coefficients in each compatible storage. `measured` holds directions, radiance and weights;
/// `reference` is the irradiance over pi at the same directions.
[[nodiscard]] std::vector<StorageErrors> storage_errors(const Codec& codec, std::span<const Rgb> c,
                                                        std::span<const Storage* const> storages, SampleView measured,
                                                        ColourView reference);

}  // namespace lobelia
