// RGB9E5: three mantissas of 9 bits and a common exponent in 32 bits, all >= 0. EXT_texture_shared_exponent (2004).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "lobelia/math.h"
#include "lobelia/pack/nearest_whole.h"

namespace lobelia::texels {

/// The largest value: 511 / 512 of 2^16.
inline constexpr float k_largest_rgb9e5 = 65408;

/// A component is mantissa * 2^(exponent - 24). Red is lowest, the exponent highest.
[[nodiscard]] constexpr std::uint32_t rgb9e5_from(Rgb c) {
    const auto cut = [](float v) { return std::min(std::max(v, 0.0f), k_largest_rgb9e5); };
    const float r = cut(c.r), g = cut(c.g), b = cut(c.b), largest = std::max({r, g, b});

    // Take the least exponent with which the largest component, rounded, has 9 bits.
    const auto floor_log2 = [](float v) { return static_cast<int>(std::bit_cast<std::uint32_t>(v) >> 23) - 127; };
    std::uint32_t exponent = static_cast<std::uint32_t>(std::max(floor_log2(largest), -16) + 16);
    const auto steps_of = [](std::uint32_t e) { return std::bit_cast<float>((127 + 24 - e) << 23); };
    const auto rounded = [](float v, float steps) { return nearest_whole(v * steps); };
    if (rounded(largest, steps_of(exponent)) == 512) ++exponent;
    const float steps = steps_of(exponent);
    return rounded(r, steps) | rounded(g, steps) << 9 | rounded(b, steps) << 18 | exponent << 27;
}

[[nodiscard]] constexpr Rgb rgb_from_rgb9e5(std::uint32_t packed) {
    const float step = std::bit_cast<float>((127 - 24 + (packed >> 27)) << 23);
    return {static_cast<float>(packed & 511) * step, static_cast<float>(packed >> 9 & 511) * step,
            static_cast<float>(packed >> 18 & 511) * step};
}

void encode_rgb9e5(const float* const* in, std::size_t count, std::byte* out);
void decode_rgb9e5(const std::byte* bytes, std::size_t count, float* const* out);

}  // namespace lobelia::texels
