// RGBM, many texels at once.
#include "lobelia/pack/rgbm.h"

#include "lobelia/planes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/pack/rgbm.cpp"
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
    return hn::Min(hn::Max(hn::LoadU(d, in), hn::Zero(d)), hn::Set(d, 1.0f));
}

void EncodeRgbm(const float* const* in, std::size_t count, std::int32_t* out) {
    const D d;
    const I di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const V r = cut(in[0] + i), g = cut(in[1] + i), b = cut(in[2] + i), largest = hn::Max(hn::Max(r, g), b);
        const V factor = hn::Max(hn::Ceil(hn::Mul(largest, hn::Set(d, 255.0f))), hn::Set(d, 1.0f));
        const V steps = hn::Div(hn::Set(d, 65025.0f), factor);
        const auto rounded = [&](V v) {
            return hn::ConvertTo(di, hn::Min(hn::Add(hn::Mul(v, steps), hn::Set(d, 0.5f)), hn::Set(d, 255.0f)));
        };
        const VI rg = hn::Or(rounded(r), hn::ShiftLeft<8>(rounded(g)));
        const VI bm = hn::Or(hn::ShiftLeft<16>(rounded(b)), hn::ShiftLeft<24>(hn::ConvertTo(di, factor)));
        hn::StoreU(hn::Or(rg, bm), di, out + i);
    }
}

void DecodeRgbm(const std::uint32_t* in, std::size_t count, float* const* out) {
    const D d;
    const hn::RebindToUnsigned<D> u;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto packed = hn::LoadU(u, in + i);
        const auto number = [&](auto word) {
            return hn::ConvertTo(d, hn::BitCast(I(), hn::And(word, hn::Set(u, 255))));
        };
        const V step = hn::Div(number(hn::ShiftRight<24>(packed)), hn::Set(d, 65025.0f));
        hn::StoreU(hn::Mul(number(packed), step), d, out[0] + i);
        hn::StoreU(hn::Mul(number(hn::ShiftRight<8>(packed)), step), d, out[1] + i);
        hn::StoreU(hn::Mul(number(hn::ShiftRight<16>(packed)), step), d, out[2] + i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeRgbm);
HWY_EXPORT(DecodeRgbm);

void encode_rgbm(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeRgbm)(in, count, reinterpret_cast<std::int32_t*>(out));
}
void decode_rgbm(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeRgbm)(reinterpret_cast<const std::uint32_t*>(bytes), count, out);
}

}  // namespace lobelia::texels
#endif
