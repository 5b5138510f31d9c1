// Packs, unpacks and measures coefficients.
#include "measure/storage_errors.h"

#include "lobelia/metrics.h"

namespace lobelia {
namespace {

double part(Rgb c, std::size_t k) { return k == 0 ? c.r : k == 1 ? c.g : c.b; }

/// The largest errors that the storage's bound allows the values of a single texel.
std::vector<float> allowed_errors(const Storage& storage, const CoefficientTraits& traits, std::span<const Rgb> c) {
    std::vector<float> values(3 * c.size()), allowed(values.size());
    CoefficientPlanes in(1, 1, {});
    MutableCoefficientPlanes out(1, 1, {});
    for (std::size_t p = 0; p < values.size(); ++p) {
        values[p] = static_cast<float>(part(c[p / 3], p % 3));
        in.planes.push_back(&values[p]);
        out.planes.push_back(&allowed[p]);
    }
    allowed_error(storage, traits, in, out);
    return allowed;
}

/// Compares the errors of coefficients with their bounds.
void measure_coefficients(const std::vector<float>& allowed, std::span<const Rgb> c, std::span<const Rgb> read,
                          StorageErrors& result) {
    double largest = 0;
    for (std::size_t p = 0; p < allowed.size(); ++p) largest = std::max(largest, std::abs(part(c[p / 3], p % 3)));
    if (!(largest > 0)) return;
    for (std::size_t p = 0; p < allowed.size(); ++p) {
        const double value = part(c[p / 3], p % 3), error = std::abs(part(read[p / 3], p % 3) - value);
        result.largest_error = std::max(result.largest_error, error / largest);
        if (allowed[p] == HUGE_VALF) {
            ++result.cut;
            continue;
        }
        result.bound = std::max(result.bound, allowed[p] / largest);
        // Values are rounded to float once more when they are put together.
        if (error > 0) result.bound_used = std::max(result.bound_used, error / (allowed[p] + 1e-6 * std::abs(value)));
    }
}

}  // namespace

std::vector<StorageErrors> storage_errors(const Codec& codec, std::span<const Rgb> c,
                                          std::span<const Storage* const> storages, SampleView measured,
                                          ColourView reference) {
    const CoefficientTraits traits = coefficient_traits(*codec.encoder());
    const std::span weights{measured.solid_angles(), measured.size};
    std::vector<StorageErrors> results;
    Colours values(measured.size);
    for (const Storage* storage : storages) {
        if (!suits(*storage, traits)) continue;
        StorageErrors result{.storage = std::string(storage->name), .bytes = bytes_per_texel(storage->layout(traits))};
        const auto read = stored_and_read(*storage, traits, c);
        measure_coefficients(allowed_errors(*storage, traits, c), c, read, result);
        codec.radiance(read, measured.directions(), values);
        result.radiance_rms = errors(values, measured.radiance(), weights).rms;
        codec.irradiance(read, measured.directions(), values);
        scale(values, k_over_pi);
        result.irradiance_over_pi_rms = errors(values, reference, weights).rms;
        results.push_back(std::move(result));
    }
    return results;
}

}  // namespace lobelia
