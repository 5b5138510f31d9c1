// Storages: finding them, traits of codecs, error bounds.
#include "lobelia/storage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobelia/codec.h"

namespace lobelia {
namespace {

using Of = ErrorBound::Of;
using Suits = Storage::Suits;

/// Says why a storage cannot be used, and names those that can.
Error unsuitable(const Storage& storage, const CoefficientTraits& traits) {
    constexpr std::array<std::string_view, 4> needs = {"any", "non-negative coefficients",
                                                       "coefficients that are colours",
                                                       "coefficients that the first of them bounds"};
    std::string suitable;
    for (const Storage& other : storages())
        if (suits(other, traits)) suitable += (suitable.empty() ? "" : ", ") + std::string(other.name);
    return Error{"storage \"" + std::string(storage.name) + "\" requires " +
                 std::string(needs[static_cast<std::size_t>(storage.suits)]) + "; usable with this codec: " + suitable};
}

void check_traits(const Storage& storage, const CoefficientTraits& traits, SourcePlace place = SourcePlace::here()) {
    if (!suits(storage, traits)) contract_violated(unsuitable(storage, traits).message, place);
}

/// Largest magnitude of a texel's three channels of a coefficient.
float largest_channel(const CoefficientPlanes& c, std::size_t coefficient, std::size_t texel) {
    float largest = 0;
    for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(c.planes[3 * coefficient + k][texel]));
    return largest;
}

/// Largest difference, in any channel of a coefficient, within the square of texels that holds (x, y).
float spread_at(const CoefficientPlanes& c, std::size_t coefficient, std::size_t x, std::size_t y, std::size_t side) {
    const std::size_t left = x / side * side, top = y / side * side;
    float spread = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const float* plane = c.planes[3 * coefficient + k];
        float low = HUGE_VALF, high = -HUGE_VALF;
        for (std::size_t v = top; v < std::min(top + side, c.height); ++v)
            for (std::size_t u = left; u < std::min(left + side, c.width); ++u) {
                low = std::min(low, plane[v * c.width + u]);
                high = std::max(high, plane[v * c.width + u]);
            }
        spread = std::max(spread, high - low);
    }
    return spread;
}

/// Returns whether the storage can hold a texel's value without clamping.
bool is_within(const Storage& storage, const CoefficientTraits& traits, const CoefficientPlanes& c, std::size_t plane,
               std::size_t texel) {
    const float value = c.planes[plane][texel];
    if (storage.suits == Suits::non_negative) return value >= 0;
    if (storage.suits != Suits::bounded_by_lead) return true;
    const float lead = c.planes[plane % 3][texel];
    return lead >= 0 && std::abs(value) <= traits.lead_bounds[plane / 3] * lead * (1 + 1e-6f);
}

/// The bound at one texel of one plane. `scale`: what its values are divided by before they are stored.
double bound_at(const ErrorBound& bound, const CoefficientTraits& traits, const CoefficientPlanes& c, std::size_t plane,
                std::size_t texel) {
    const std::size_t i = plane / 3, of = bound.of == Of::lead ? 0 : i;
    const double factor = bound.of == Of::lead ? traits.lead_bounds[i] : 1;
    const double magnitude = bound.of == Of::value ? std::abs(c.planes[plane][texel]) : largest_channel(c, of, texel);
    double allowed = bound.relative * magnitude + bound.absolute;
    if (bound.spread > 0) allowed += bound.spread * spread_at(c, of, texel % c.width, texel / c.width, bound.shared);
    return allowed * factor;
}

}  // namespace

CoefficientTraits coefficient_traits(const Encoder& encoder) {
    const Basis& basis = encoder.basis();
    return {basis.size(), encoder.is_non_negative(), basis.has_colours(), basis.lead_bounds()};
}

CoefficientTraits coefficient_traits(const std::shared_ptr<const Basis>& basis) {
    CoefficientTraits traits{basis->size(), false, basis->has_colours(), basis->lead_bounds()};
    if (basis->linear() == nullptr || !basis->linear()->is_non_negative()) return traits;
    for (const auto& encoder : encoder_names(*basis))
        traits.non_negative = traits.non_negative || make_encoder(encoder, basis).value()->is_non_negative();
    return traits;
}

bool suits(const Storage& storage, const CoefficientTraits& traits) {
    switch (storage.suits) {
        case Suits::any:
            return true;
        case Suits::non_negative:
            return traits.non_negative;
        case Suits::colours:
            return traits.colours;
        case Suits::bounded_by_lead:
            return !traits.lead_bounds.empty();
    }
    return false;
}

bool shares_texels(const Storage& storage) {
    const CoefficientTraits any{1, true, true, {1}};
    return shares_texels(storage.layout(any));
}

Result<const Storage*> find_storage(std::string_view name) {
    std::vector<std::string> known;
    for (const Storage& storage : storages()) {
        if (storage.name == name) return &storage;
        known.emplace_back(storage.name);
    }
    return Error{"unknown storage \"" + std::string(name) + "\"" + nearest_names(name, known)};
}

Result<std::vector<const Storage*>> find_storages(std::span<const std::string> names, const CoefficientTraits& traits) {
    std::vector<const Storage*> found;
    for (const std::string& name : names) {
        const auto storage = find_storage(name);
        if (!storage) return storage.error();
        if (!suits(**storage, traits)) return unsuitable(**storage, traits);
        if (std::find(found.begin(), found.end(), *storage) == found.end()) found.push_back(*storage);
    }
    return found;
}

void allowed_error(const Storage& storage, const CoefficientTraits& traits, const CoefficientPlanes& coefficients,
                   const MutableCoefficientPlanes& out) {
    check_traits(storage, traits);
    check_equal("planes of coefficients", coefficients.planes.size(), 3 * traits.count);
    check_equal("planes of bounds", out.planes.size(), coefficients.planes.size());
    check_equal("texels of the bounds", out.size(), coefficients.size());
    const TextureLayout layout = storage.layout(traits);
    float largest = 0;
    for (const float* plane : coefficients.planes)
        largest = std::max(largest, largest_magnitude(plane, coefficients.size()));
    // Scale the absolute error like the values, which are divided if they are too large for the format.
    ErrorBound bound = storage.bound;
    bound.absolute *= storing_scale(layout.textures.front().format, largest);
    for (std::size_t p = 0; p < coefficients.planes.size(); ++p) {
        float in_texture = 0;
        for (std::size_t k = 0; bound.of_texture > 0 && k < 3; ++k)
            in_texture =
                std::max(in_texture, largest_magnitude(coefficients.planes[p / 3 * 3 + k], coefficients.size()));
        for (std::size_t i = 0; i < coefficients.size(); ++i) {
            const double allowed = bound_at(bound, traits, coefficients, p, i) + bound.of_texture * in_texture;
            out.planes[p][i] = is_within(storage, traits, coefficients, p, i) ? static_cast<float>(allowed) : HUGE_VALF;
        }
    }
}

std::vector<Rgb> stored_and_read(const Storage& storage, const CoefficientTraits& traits, std::span<const Rgb> c) {
    check_traits(storage, traits);
    check_equal("coefficients", c.size(), traits.count);
    std::vector<float> in(3 * c.size()), back(in.size());
    CoefficientPlanes planes(1, 1, {});
    MutableCoefficientPlanes read(1, 1, {});
    for (std::size_t i = 0; i < c.size(); ++i) {
        in[3 * i] = c[i].r;
        in[3 * i + 1] = c[i].g;
        in[3 * i + 2] = c[i].b;
    }
    for (std::size_t p = 0; p < in.size(); ++p) {
        planes.planes.push_back(&in[p]);
        read.planes.push_back(&back[p]);
    }
    const TextureLayout layout = storage.layout(traits);
    unpack(layout, pack(layout, planes), read);
    std::vector<Rgb> result(c.size());
    for (std::size_t i = 0; i < c.size(); ++i) result[i] = {back[3 * i], back[3 * i + 1], back[3 * i + 2]};
    return result;
}

}  // namespace lobelia
