// Float32 texels as they are; float16 texels as half_from_float() rounds them, the largest for what is not finite.
#include "core/storage/format/floats.h"

#include <algorithm>
#include <limits>

#include "core/math/half.h"
#include "core/storage/format/format_entry.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/floats.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/storage/format/words-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::texels::HWY_NAMESPACE {

using U16 = hn::Rebind<std::uint16_t, D>;

HWY_INLINE VU bits_of(V v) { return hn::BitCast(U(), v); }
HWY_INLINE V float_of(VU v) { return hn::BitCast(D(), v); }

/// half_from_float(), but for NaN.
HWY_INLINE VU half_bits(V value) {
    const U u;
    const VU bits = bits_of(value);
    const VU magnitude = hn::Min(hn::And(bits, hn::Set(u, 0x7fffffff)), hn::Set(u, 0x477fe000));
    const VU rebiased = hn::Sub(magnitude, hn::Set(u, (127 - 15) << 23));
    const VU odd = hn::And(hn::ShiftRight<13>(rebiased), hn::Set(u, 1));
    const VU normal = hn::ShiftRight<13>(hn::Add(hn::Add(rebiased, hn::Set(u, 0xfff)), odd));
    const V half = hn::Set(D(), 0.5f);
    const VU subnormal = hn::Sub(bits_of(hn::Add(float_of(magnitude), half)), bits_of(half));
    const auto is_normal = hn::Ge(float_of(magnitude), hn::Set(D(), 0x1p-14f));
    const VU found = hn::IfThenElse(hn::RebindMask(u, is_normal), normal, subnormal);
    return hn::Or(found, hn::And(hn::ShiftRight<16>(bits), hn::Set(u, 0x8000)));
}

/// float_from_half() of the lower 16 bits.
HWY_INLINE V float_of_half(VU half) {
    const U u;
    const VU sign = hn::ShiftLeft<16>(hn::And(half, hn::Set(u, 0x8000)));
    const VU shifted = hn::ShiftLeft<13>(hn::And(half, hn::Set(u, 0x7fff)));
    const VU rebiased = hn::Add(shifted, hn::Set(u, (127 - 15) << 23));
    // Infinity and NaN move on to the largest exponent; below the least normal half the mantissa counts 2^-24.
    const auto special = hn::Gt(hn::BitCast(I(), shifted), hn::Set(I(), (31 << 23) - 1));
    const VU large =
        hn::IfThenElse(hn::RebindMask(u, special), hn::Add(rebiased, hn::Set(u, (128 - 16) << 23)), rebiased);
    const auto tiny = hn::Lt(hn::BitCast(I(), shifted), hn::Set(I(), 1 << 23));
    const V least = hn::Sub(float_of(hn::Add(rebiased, hn::Set(u, 1 << 23))), hn::Set(D(), 0x1p-14f));
    return float_of(hn::Or(sign, hn::IfThenElse(hn::RebindMask(u, tiny), bits_of(least), large)));
}

void EncodeFloats(std::size_t channels, const float* const* in, std::size_t count, float* out) {
    const D d;
    if (channels == 1) {
        std::copy_n(in[0], count, out);
    } else if (channels == 2) {
        for (std::size_t i = 0; i < count; i += hn::Lanes(d))
            hn::StoreInterleaved2(hn::LoadU(d, in[0] + i), hn::LoadU(d, in[1] + i), d, out + 2 * i);
    } else {
        for (std::size_t i = 0; i < count; i += hn::Lanes(d))
            hn::StoreInterleaved4(hn::LoadU(d, in[0] + i), hn::LoadU(d, in[1] + i), hn::LoadU(d, in[2] + i),
                                  hn::LoadU(d, in[3] + i), d, out + 4 * i);
    }
}

void DecodeFloats(std::size_t channels, const float* in, std::size_t count, float* const* out) {
    const D d;
    if (channels == 1) {
        std::copy_n(in, count, out[0]);
        return;
    }
    V v[4];
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        if (channels == 2)
            hn::LoadInterleaved2(d, in + 2 * i, v[0], v[1]);
        else
            hn::LoadInterleaved4(d, in + 4 * i, v[0], v[1], v[2], v[3]);
        for (std::size_t k = 0; k < channels; ++k) hn::StoreU(v[k], d, out[k] + i);
    }
}

void EncodeHalves(std::size_t channels, const float* const* in, std::size_t count, std::uint16_t* out) {
    const D d;
    const U u;
    const auto halves = [&](std::size_t k, std::size_t i) { return half_bits(hn::LoadU(d, in[k] + i)); };
    const auto pair = [&](std::size_t k, std::size_t i) {
        return hn::Or(halves(k, i), hn::ShiftLeft<16>(halves(k + 1, i)));
    };
    auto* words = reinterpret_cast<std::uint32_t*>(out);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        if (channels == 1)
            hn::StoreU(hn::DemoteTo(U16(), hn::BitCast(I(), halves(0, i))), U16(), out + i);
        else if (channels == 2)
            hn::StoreU(pair(0, i), u, words + i);
        else
            hn::StoreInterleaved2(pair(0, i), pair(2, i), u, words + 2 * i);
    }
}

void DecodeHalves(std::size_t channels, const std::uint16_t* in, std::size_t count, float* const* out) {
    const D d;
    const U u;
    const auto* words = reinterpret_cast<const std::uint32_t*>(in);
    const auto store_pair = [&](VU pair, std::size_t k, std::size_t i) {
        hn::StoreU(float_of_half(pair), d, out[k] + i);
        hn::StoreU(float_of_half(hn::ShiftRight<16>(pair)), d, out[k + 1] + i);
    };
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        if (channels == 1) {
            const auto wide = hn::PromoteTo(I(), hn::LoadU(U16(), in + i));
            hn::StoreU(float_of_half(hn::BitCast(u, wide)), d, out[0] + i);
        } else if (channels == 2) {
            store_pair(hn::LoadU(u, words + i), 0, i);
        } else {
            VU first, second;
            hn::LoadInterleaved2(u, words + 2 * i, first, second);
            store_pair(first, 0, i);
            store_pair(second, 2, i);
        }
    }
}

float LargestMagnitude(const float* values, std::size_t count) {
    const D d;
    V largest = hn::Zero(d);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) largest = hn::Max(largest, hn::Abs(hn::LoadU(d, values + i)));
    return hn::GetLane(hn::MaxOfLanes(d, largest));
}

}  // namespace lobelia::texels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::texels {

HWY_EXPORT(EncodeFloats);
HWY_EXPORT(DecodeFloats);
HWY_EXPORT(EncodeHalves);
HWY_EXPORT(DecodeHalves);
HWY_EXPORT(LargestMagnitude);

namespace {

void encode_floats(std::size_t channels, const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeFloats)(channels, in, count, reinterpret_cast<float*>(out));
}
void decode_floats(std::size_t channels, const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeFloats)(channels, reinterpret_cast<const float*>(bytes), count, out);
}
void encode_halves(std::size_t channels, const float* const* in, std::size_t count, std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeHalves)(channels, in, count, reinterpret_cast<std::uint16_t*>(out));
}
void decode_halves(std::size_t channels, const std::byte* bytes, std::size_t count, float* const* out) {
    HWY_DYNAMIC_DISPATCH(DecodeHalves)(channels, reinterpret_cast<const std::uint16_t*>(bytes), count, out);
}

constexpr double k_float_max = std::numeric_limits<float>::max();

template <std::size_t channels>
constexpr FormatEntry floats(std::string_view name, std::uint32_t vk_format) {
    return {{name, channels, 1, 4 * channels, vk_format, -k_float_max, k_float_max},
            encode_with<channels, encode_floats>,
            decode_with<channels, decode_floats>};
}
template <std::size_t channels>
constexpr FormatEntry halves(std::string_view name, std::uint32_t vk_format) {
    return {{name, channels, 1, 2 * channels, vk_format, -k_largest_half, k_largest_half},
            encode_with<channels, encode_halves>,
            decode_with<channels, decode_halves>};
}

}  // namespace

constinit const FormatEntry r32f = floats<1>("r32f", 100);
constinit const FormatEntry rg32f = floats<2>("rg32f", 103);
constinit const FormatEntry rgba32f = floats<4>("rgba32f", 109);
constinit const FormatEntry r16f = halves<1>("r16f", 76);
constinit const FormatEntry rg16f = halves<2>("rg16f", 83);
constinit const FormatEntry rgba16f = halves<4>("rgba16f", 97);

float largest_magnitude(const float* values, std::size_t count) {
    const std::size_t whole = count / k_lanes * k_lanes;
    float largest = whole > 0 ? HWY_DYNAMIC_DISPATCH(LargestMagnitude)(values, whole) : 0.0f;
    for (std::size_t i = whole; i < count; ++i) largest = std::max(largest, std::abs(values[i]));
    return largest;
}

}  // namespace lobelia::texels
#endif
