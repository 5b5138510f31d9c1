// Storages: ways to keep coefficients in fewer bytes, with what each costs in accuracy.
#pragma once

#include "lobelia/encoder.h"
#include "lobelia/result.h"
#include "lobelia/texture_layout.h"

namespace lobelia {

/// Properties that a storage may rely on in a codec's coefficients.
struct CoefficientTraits {
    std::size_t count = 0;
    bool non_negative = false;       ///< every coefficient is >= 0
    bool colours = true;             ///< each is a colour, whose chroma varies less than its luma
    std::vector<float> lead_bounds;  ///< |c_i| <= lead_bounds[i] c_0 for light that is >= 0; empty where nothing bounds
};

[[nodiscard]] CoefficientTraits coefficient_traits(const Encoder& encoder);
/// Of the encoders that a basis is listed with, those of a non-negative one where it has any: most storages suit it.
[[nodiscard]] CoefficientTraits coefficient_traits(const std::shared_ptr<const Basis>& basis);

/// The largest error of storing v: relative m + of_texture t + spread s + absolute.
struct ErrorBound {
    /// What `relative` is a share of, m: the stored value alone; the largest magnitude among what is stored with it,
    /// of a texel or of a coefficient's three channels; or the largest magnitude of the leading coefficient, times
    /// what that bounds this one by.
    enum class Of { value, together, lead };
    double relative = 0;
    Of of = Of::value;
    double absolute = 0;     ///< beneath what the format can tell from 0
    double of_texture = 0;   ///< share of t, the largest magnitude in the texture
    double spread = 0;       ///< share of s, the largest difference, in any channel, within the texels that share data
    std::size_t shared = 1;  ///< those are squares of this many texels a side
};

/// A way to store coefficients; all of it is data.
struct Storage {
    /// Its requirement on coefficients.
    enum class Suits { any, non_negative, colours, bounded_by_lead };
    std::string_view name, description;
    Suits suits = Suits::any;
    ErrorBound bound;  ///< of the coefficients that are read back
    TextureLayout (*layout)(const CoefficientTraits&) = nullptr;
};

/// THE list (src/core/storage/storages.cpp).
[[nodiscard]] std::span<const Storage> storages();
[[nodiscard]] bool suits(const Storage& storage, const CoefficientTraits& traits);
/// Whether texels beside each other have bits in common, so that a single one tells nothing of the error.
[[nodiscard]] bool shares_texels(const Storage& storage);
/// By name; the error of an unknown one lists the nearest.
[[nodiscard]] Result<const Storage*> find_storage(std::string_view name);
/// By names, each once; the error of an incompatible one says what it requires and which others are usable.
[[nodiscard]] Result<std::vector<const Storage*>> find_storages(std::span<const std::string> names,
                                                                const CoefficientTraits& traits);
/// The default storages of a bake: plain halves, and ratios in bytes where they are usable.
[[nodiscard]] std::vector<const Storage*> default_storages(const CoefficientTraits& traits);

/// The largest error of `storage` by its bound, for each value of `coefficients`, into planes of the same shape;
/// HUGE_VALF where a value is outside of its limits: below 0 for formats without a sign, or beyond its
/// lead's bound.
void allowed_error(const Storage& storage, const CoefficientTraits& traits, const CoefficientPlanes& coefficients,
                   const MutableCoefficientPlanes& out);

/// The coefficients of one texel or probe as they come back from storage.
[[nodiscard]] std::vector<Rgb> stored_and_read(const Storage& storage, const CoefficientTraits& traits,
                                               std::span<const Rgb> c);

}  // namespace lobelia
