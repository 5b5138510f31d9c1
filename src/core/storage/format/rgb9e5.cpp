// RGB9E5, many texels at once.
#include "core/storage/format/rgb9e5.h"

#include "core/storage/format/format_entry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/rgb9e5.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/storage/format/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {

void EncodeRgb9e5(const float* const* in, std::size_t count, std::int32_t* out) {
    const I di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(di)) {
        const Components c = cut(in, i, k_largest_rgb9e5);
        const VI exponent_field = hn::ShiftRight<23>(hn::BitCast(di, c.largest()));
        const VI exponent = hn::Max(hn::Sub(exponent_field, hn::Set(di, 127 - 16)), hn::Zero(di));
        const V steps = power_of_two(hn::Sub(hn::Set(di, 24), exponent));
        hn::StoreU(word_of<9>(c, steps, exponent), di, out + i);
    }
}

void DecodeRgb9e5(const std::uint32_t* in, std::size_t count, float* const* out) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
        const VU packed = hn::LoadU(U(), in + i);
        const VI exponent = hn::BitCast(I(), hn::ShiftRight<27>(packed));
        store_components<9>(packed, power_of_two(hn::Sub(exponent, hn::Set(I(), 24))), out, i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeRgb9e5);
HWY_EXPORT(DecodeRgb9e5);

namespace {

void encode_rgb9e5(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeRgb9e5)(in, count, reinterpret_cast<std::int32_t*>(out));
}
void decode_rgb9e5(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeRgb9e5)(reinterpret_cast<const std::uint32_t*>(bytes), count, out);
}

}  // namespace

constinit const FormatEntry rgb9e5 = {{"rgb9e5", 3, 1, 4, 123, 0, k_largest_rgb9e5}, encode_rgb9e5, decode_rgb9e5};

}  // namespace lobelia::texels
#endif
