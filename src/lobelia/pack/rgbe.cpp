// RGBE, many texels at once.
#include "lobelia/pack/rgbe.h"

#include "lobelia/planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/pack/rgbe.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, k_lanes>;
using I = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<I>;

HWY_INLINE V cut(const float* in) {
    const D d;
    return hn::Min(hn::Max(hn::LoadU(d, in), hn::Zero(d)), hn::Set(d, k_largest_rgbe));
}
HWY_INLINE VI rounded(V v, V steps) {
    return hn::Min(hn::ConvertTo(I(), hn::Add(hn::Mul(v, steps), hn::Set(D(), 0.5f))), hn::Set(I(), 255));
}
/// 2^(136 - exponent).
HWY_INLINE V steps_of(VI exponent) {
    return hn::BitCast(D(), hn::ShiftLeft<23>(hn::Sub(hn::Set(I(), 127 + 136), exponent)));
}

void EncodeRgbe(const float* const* in, std::size_t count, std::int32_t* out) {
    const I di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(di)) {
        const V r = cut(in[0] + i), g = cut(in[1] + i), b = cut(in[2] + i), largest = hn::Max(hn::Max(r, g), b);
        const VI exponent = hn::Add(hn::ShiftRight<23>(hn::BitCast(di, largest)), hn::Set(di, 2));
        const V steps = steps_of(exponent);
        const VI rg = hn::Or(rounded(r, steps), hn::ShiftLeft<8>(rounded(g, steps)));
        const VI be = hn::Or(hn::ShiftLeft<16>(rounded(b, steps)), hn::ShiftLeft<24>(exponent));
        const auto lit = hn::RebindMask(di, hn::Ge(largest, hn::Set(D(), k_least_rgbe)));
        hn::StoreU(hn::IfThenElseZero(lit, hn::Or(rg, be)), di, out + i);
    }
}

void DecodeRgbe(const std::uint32_t* in, std::size_t count, float* const* out) {
    const D d;
    const hn::RebindToUnsigned<D> u;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto packed = hn::LoadU(u, in + i);
        const auto exponent = hn::ShiftRight<24>(packed), half = hn::ShiftRight<1>(exponent);
        const auto power = [&](auto e) { return hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(e, hn::Set(u, 127 - 68)))); };
        const auto lit = hn::Gt(hn::BitCast(I(), exponent), hn::Zero(I()));
        const V step = hn::IfThenElseZero(hn::RebindMask(d, lit), hn::Mul(power(half), power(hn::Sub(exponent, half))));
        const auto store = [&](auto word, float* to) {
            const auto mantissa = hn::And(word, hn::Set(u, 255));
            hn::StoreU(hn::Mul(hn::ConvertTo(d, hn::BitCast(I(), mantissa)), step), d, to);
        };
        store(packed, out[0] + i);
        store(hn::ShiftRight<8>(packed), out[1] + i);
        store(hn::ShiftRight<16>(packed), out[2] + i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeRgbe);
HWY_EXPORT(DecodeRgbe);

void encode_rgbe(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeRgbe)(in, count, reinterpret_cast<std::int32_t*>(out));
}
void decode_rgbe(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeRgbe)(reinterpret_cast<const std::uint32_t*>(bytes), count, out);
}

}  // namespace lobelia::texels
#endif
