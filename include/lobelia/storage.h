// Storages: compact forms of coefficients, with the error of each.
#pragma once

#include "lobelia/encoder.h"
#include "lobelia/result.h"
#include "lobelia/texture_layout.h"

namespace lobelia {

/// Properties that a storage may rely on in a codec's coefficients.
struct CoefficientTraits {
    std::size_t count = 0;
    bool non_negative = false;       ///< every coefficient is >= 0
    bool colours = true;             ///< each is a colour, with less variation in chroma than in luma
    std::vector<float> lead_bounds;  ///< |c_i| <= lead_bounds[i] c_0 for light that is >= 0; empty: no bounds
};

[[nodiscard]] CoefficientTraits coefficient_traits(const Encoder& encoder);
/// Returns the traits for the encoders that a basis is listed with: those of a non-negative encoder if there is one,
/// since most storages support it.
[[nodiscard]] CoefficientTraits coefficient_traits(const std::shared_ptr<const Basis>& basis);

/// The maximum error of storing v: relative m + of_texture t + spread s + absolute.
struct ErrorBound {
    /// Definition of m, the reference of `relative`. value: the stored value. together: the largest magnitude among
    /// values stored together, of a texel or of a coefficient's three channels. lead: the largest magnitude of the
    /// leading coefficient, times its bound of this one.
    enum class Of { value, together, lead };
    double relative = 0;
    Of of = Of::value;
    double absolute = 0;    ///< for values too small for the format
    double of_texture = 0;  ///< fraction of t, the largest magnitude in the texture
    double spread = 0;  ///< fraction of s, the largest difference, in any channel, within the texels that share data
    std::size_t shared = 1;  ///< side of the squares of texels that share data
};

/// A way to store coefficients, described by data.
struct Storage {
    /// Its requirement on coefficients.
    enum class Suits { any, non_negative, colours, bounded_by_lead };
    std::string_view name, description;
    Suits suits = Suits::any;
    ErrorBound bound;  ///< error of the unpacked coefficients
    TextureLayout (*layout)(const CoefficientTraits&) = nullptr;
};

/// Returns the list of all storages (src/core/storage/storages.cpp).
[[nodiscard]] std::span<const Storage> storages();
[[nodiscard]] bool suits(const Storage& storage, const CoefficientTraits& traits);
/// Returns whether neighbouring texels share data, so that the error of a single one is not representative.
[[nodiscard]] bool shares_texels(const Storage& storage);
/// Finds a storage by name. Errors: an unknown name; the message suggests the nearest.
[[nodiscard]] Result<const Storage*> find_storage(std::string_view name);
/// Finds storages by names, without duplicates. Errors: an unknown name; an incompatible storage, with its requirement
/// and the usable ones.
[[nodiscard]] Result<std::vector<const Storage*>> find_storages(std::span<const std::string> names,
                                                                const CoefficientTraits& traits);
/// Returns the default storages of a bake: plain halves, and ratios in bytes where they are usable.
[[nodiscard]] std::vector<const Storage*> default_storages(const CoefficientTraits& traits);

/// Computes the maximum error of `storage` by its bound, for each value of `coefficients`, into planes of the same
/// shape; HUGE_VALF if a value is outside its limits: below 0 for unsigned formats, or beyond its lead's bound.
void allowed_error(const Storage& storage, const CoefficientTraits& traits, const CoefficientPlanes& coefficients,
                   const MutableCoefficientPlanes& out);

/// Packs and unpacks the coefficients of one texel or probe.
[[nodiscard]] std::vector<Rgb> stored_and_read(const Storage& storage, const CoefficientTraits& traits,
                                               std::span<const Rgb> c);

}  // namespace lobelia
