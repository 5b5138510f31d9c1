// What vectorised texel formats start with, the vector types; and what those of one 32-bit word have in common: three
// mantissas, lowest first, and what scales them above. For sources that Highway includes once for each target, after
// highway.h.
#if defined(LOBELIA_PACK_WORDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_PACK_WORDS_INL_H
#undef LOBELIA_PACK_WORDS_INL_H
#else
#define LOBELIA_PACK_WORDS_INL_H
#endif

#include <hwy/highway.h>

#include "lobelia/planes.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, k_lanes>;
using I = hn::RebindToSigned<D>;
using U = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<I>;
using VU = hn::Vec<U>;

/// Components of some texels, cut to [0, largest].
struct Components {
    V r, g, b;
    [[nodiscard]] HWY_INLINE V largest() const { return hn::Max(hn::Max(r, g), b); }
};
HWY_INLINE Components cut(const float* const* in, std::size_t i, float largest) {
    const D d;
    const auto component = [&](std::size_t k) {
        return hn::Min(hn::Max(hn::LoadU(d, in[k] + i), hn::Zero(d)), hn::Set(d, largest));
    };
    return {component(0), component(1), component(2)};
}

/// Mantissas of `Bits` bits, each component times `steps` to the nearest, below the word's uppermost bits.
template <int Bits>
HWY_INLINE VI word_of(const Components& c, V steps, VI uppermost) {
    const auto mantissa = [&](V v) {
        return hn::Min(hn::ConvertTo(I(), hn::Add(hn::Mul(v, steps), hn::Set(D(), 0.5f))),
                       hn::Set(I(), (1 << Bits) - 1));
    };
    const VI rg = hn::Or(mantissa(c.r), hn::ShiftLeft<Bits>(mantissa(c.g)));
    return hn::Or(rg, hn::Or(hn::ShiftLeft<2 * Bits>(mantissa(c.b)), hn::ShiftLeft<3 * Bits>(uppermost)));
}
/// The mantissas of a word times `step`.
template <int Bits>
HWY_INLINE void store_components(VU word, V step, float* const* out, std::size_t i) {
    const D d;
    const auto store = [&](VU mantissa, float* to) {
        const VU lowest = hn::And(mantissa, hn::Set(U(), (1u << Bits) - 1));
        hn::StoreU(hn::Mul(hn::ConvertTo(d, hn::BitCast(I(), lowest)), step), d, to + i);
    };
    store(word, out[0]);
    store(hn::ShiftRight<Bits>(word), out[1]);
    store(hn::ShiftRight<2 * Bits>(word), out[2]);
}
/// 2^exponent, for exponents of normal floats.
HWY_INLINE V power_of_two(VI exponent) {
    return hn::BitCast(D(), hn::ShiftLeft<23>(hn::Add(exponent, hn::Set(I(), 127))));
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
