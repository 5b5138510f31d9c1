// Normalised texels: a byte for each of one, two or four channels; three channels of 10 bits, the first lowest, the
// upper two bits set.
#include "core/storage/format/unorm.h"

#include "core/storage/format/format_entry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/unorm.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/storage/format/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {

using U8 = hn::Rebind<std::uint8_t, D>;
using U16 = hn::Rebind<std::uint16_t, D>;

HWY_INLINE VU unorm(const float* in, float steps) {
    const D d;
    const V cut = hn::Min(hn::Max(hn::LoadU(d, in), hn::Zero(d)), hn::Set(d, 1.0f));
    const V scaled = hn::Add(hn::Mul(cut, hn::Set(d, steps)), hn::Set(d, 0.5f));
    return hn::BitCast(U(), hn::ConvertTo(I(), scaled));
}

/// Stores the lowest bits of `word` divided by `steps`.
HWY_INLINE void store_fraction(VU word, std::uint32_t steps, float* out) {
    const D d;
    const V stored = hn::ConvertTo(d, hn::BitCast(I(), hn::And(word, hn::Set(U(), steps))));
    hn::StoreU(hn::Div(stored, hn::Set(d, static_cast<float>(steps))), d, out);
}

void EncodeUnorm8(std::size_t channels, const float* const* in, std::size_t count, std::uint8_t* out) {
    const auto byte = [&](std::size_t k, std::size_t i) { return unorm(in[k] + i, 255); };
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
        if (channels == 1) {
            hn::StoreU(hn::DemoteTo(U8(), hn::BitCast(I(), byte(0, i))), U8(), out + i);
            continue;
        }
        const VU pair = hn::Or(byte(0, i), hn::ShiftLeft<8>(byte(1, i)));
        if (channels == 2) {
            hn::StoreU(hn::DemoteTo(U16(), hn::BitCast(I(), pair)), U16(), reinterpret_cast<std::uint16_t*>(out) + i);
            continue;
        }
        const VU second = hn::Or(hn::ShiftLeft<16>(byte(2, i)), hn::ShiftLeft<24>(byte(3, i)));
        hn::StoreU(hn::Or(pair, second), U(), reinterpret_cast<std::uint32_t*>(out) + i);
    }
}

void DecodeUnorm8(std::size_t channels, const std::uint8_t* in, std::size_t count, float* const* out) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
        VU word;
        if (channels == 1)
            word = hn::BitCast(U(), hn::PromoteTo(I(), hn::LoadU(U8(), in + i)));
        else if (channels == 2)
            word =
                hn::BitCast(U(), hn::PromoteTo(I(), hn::LoadU(U16(), reinterpret_cast<const std::uint16_t*>(in) + i)));
        else
            word = hn::LoadU(U(), reinterpret_cast<const std::uint32_t*>(in) + i);
        store_fraction(word, 255, out[0] + i);
        if (channels >= 2) store_fraction(hn::ShiftRight<8>(word), 255, out[1] + i);
        if (channels < 4) continue;
        store_fraction(hn::ShiftRight<16>(word), 255, out[2] + i);
        store_fraction(hn::ShiftRight<24>(word), 255, out[3] + i);
    }
}

void EncodeUnorm10(const float* const* in, std::size_t count, std::uint32_t* out) {
    const auto part = [&](std::size_t k, std::size_t i) { return unorm(in[k] + i, 1023); };
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
        const VU upper = hn::Or(hn::ShiftLeft<20>(part(2, i)), hn::Set(U(), 3u << 30));
        hn::StoreU(hn::Or(hn::Or(part(0, i), hn::ShiftLeft<10>(part(1, i))), upper), U(), out + i);
    }
}

void DecodeUnorm10(const std::uint32_t* in, std::size_t count, float* const* out) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
        const VU word = hn::LoadU(U(), in + i);
        store_fraction(word, 1023, out[0] + i);
        store_fraction(hn::ShiftRight<10>(word), 1023, out[1] + i);
        store_fraction(hn::ShiftRight<20>(word), 1023, out[2] + i);
    }
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeUnorm8);
HWY_EXPORT(DecodeUnorm8);
HWY_EXPORT(EncodeUnorm10);
HWY_EXPORT(DecodeUnorm10);

namespace {

void encode_unorm8(std::size_t channels, const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeUnorm8)(channels, in, count, reinterpret_cast<std::uint8_t*>(out));
}
void decode_unorm8(std::size_t channels, const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeUnorm8)(channels, reinterpret_cast<const std::uint8_t*>(bytes), count, out);
}
void encode_unorm10(const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeUnorm10)(in, count, reinterpret_cast<std::uint32_t*>(out));
}
void decode_unorm10(const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeUnorm10)(reinterpret_cast<const std::uint32_t*>(bytes), count, out);
}

template <std::size_t channels>
constexpr FormatEntry unorm8(std::string_view name, std::uint32_t vk_format) {
    return {{name, channels, 1, channels, vk_format, 0, 1},
            encode_with<channels, encode_unorm8>,
            decode_with<channels, decode_unorm8>};
}

}  // namespace

constinit const FormatEntry r8 = unorm8<1>("r8", 9);
constinit const FormatEntry rg8 = unorm8<2>("rg8", 16);
constinit const FormatEntry rgba8 = unorm8<4>("rgba8", 37);
constinit const FormatEntry rgb10a2 = {{"rgb10a2", 3, 1, 4, 64, 0, 1}, encode_unorm10, decode_unorm10};

}  // namespace lobelia::texels
#endif
