// Many Sobol pairs at once, in vector lanes: the same bits as pair_of.
#include "core/sample/sequence.h"

#include "lobelia/planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/sample/sequence_pairs.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::CappedTag<std::uint32_t, k_lanes>;
using DF = hn::CappedTag<float, k_lanes>;
using U = hn::Vec<DU>;

HWY_INLINE U constant(std::uint32_t v) { return hn::Set(DU(), v); }

template <int kShift>
HWY_INLINE U swap_bits(U v, std::uint32_t low) {
    const U mask = constant(low);
    return hn::Or(hn::ShiftLeft<kShift>(hn::And(v, mask)), hn::And(hn::ShiftRight<kShift>(v), mask));
}
HWY_INLINE U reverse_bits(U v) {
    v = hn::Or(hn::ShiftLeft<16>(v), hn::ShiftRight<16>(v));
    return swap_bits<1>(swap_bits<2>(swap_bits<4>(swap_bits<8>(v, 0x00ff00ffu), 0x0f0f0f0fu), 0x33333333u),
                        0x55555555u);
}

HWY_INLINE U mix(U value, std::uint32_t salt) {
    U x = hn::Add(value, constant(0x9e3779b9u * (salt + 1)));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<16>(x)), constant(0x21f0aaadu));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<15>(x)), constant(0x735a2d97u));
    return hn::Xor(x, hn::ShiftRight<15>(x));
}

HWY_INLINE U scramble_mirrored(U v, U seed) {
    v = hn::Xor(v, hn::Mul(v, constant(0x3d20adeau)));
    v = hn::Add(v, seed);
    v = hn::Mul(v, hn::Or(hn::ShiftRight<16>(seed), constant(1)));
    v = hn::Xor(v, hn::Mul(v, constant(0x05526c56u)));
    return hn::Xor(v, hn::Mul(v, constant(0x53a22864u)));
}

HWY_INLINE U second_dimension_mirrored(U i) {
    i = hn::Xor(i, hn::ShiftRight<16>(i));
    i = hn::Xor(i, hn::ShiftRight<8>(hn::And(i, constant(0xff00ff00u))));
    i = hn::Xor(i, hn::ShiftRight<4>(hn::And(i, constant(0xf0f0f0f0u))));
    i = hn::Xor(i, hn::ShiftRight<2>(hn::And(i, constant(0xccccccccu))));
    return hn::Xor(i, hn::ShiftRight<1>(hn::And(i, constant(0xaaaaaaaau))));
}

HWY_INLINE void store_unit(U bits, float* to) {
    const DF d;
    const auto whole = hn::ConvertTo(d, hn::BitCast(hn::RebindToSigned<DU>(), hn::ShiftRight<8>(bits)));
    hn::StoreU(hn::Mul(whole, hn::Set(d, 0x1p-24f)), d, to);
}

void FillPairs(const std::uint32_t* mixed_keys, const std::uint32_t* samples, std::size_t count,
               std::uint32_t dimension_pair, float* a, float* b) {
    const DU d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const U seed = mix(hn::LoadU(d, mixed_keys + i), dimension_pair);
        const U index = reverse_bits(scramble_mirrored(reverse_bits(hn::LoadU(d, samples + i)), seed));
        store_unit(reverse_bits(scramble_mirrored(index, mix(seed, 1))), a + i);
        store_unit(reverse_bits(scramble_mirrored(second_dimension_mirrored(index), mix(seed, 2))), b + i);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(FillPairs);

void pairs_of(std::span<const std::uint32_t> mixed_keys, std::span<const std::uint32_t> samples,
              std::uint32_t dimension_pair, Pairs& out) {
    LOBELIA_ASSERT(mixed_keys.size() == samples.size() && mixed_keys.size() % k_lanes == 0);
    LOBELIA_ASSERT(mixed_keys.size() <= out.a.size());
    HWY_DYNAMIC_DISPATCH(FillPairs)
    (mixed_keys.data(), samples.data(), samples.size(), dimension_pair, out.a.data(), out.b.data());
}

}  // namespace lobelia
#endif
