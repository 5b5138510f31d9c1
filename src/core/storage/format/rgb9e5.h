// RGB9E5: three mantissas of 9 bits and a common exponent in 32 bits, all >= 0. EXT_texture_shared_exponent (2004).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/storage/format/nearest_whole.h"
#include "lobelia/math.h"

namespace lobelia::texels {

/// The largest value: 511 / 512 of 2^16.
inline constexpr float k_largest_rgb9e5 = 65408;

/// A component is mantissa * 2^(exponent - 24). Red is lowest, the exponent highest.
[[nodiscard]] constexpr std::uint32_t rgb9e5_from(Rgb c) {
    const auto cut = [](float v) { return std::min(std::max(v, 0.0f), k_largest_rgb9e5); };
    const float r = cut(c.r), g = cut(c.g), b = cut(c.b), largest = std::max({r, g, b});

    // Take the least exponent with which the largest component, rounded down, has 9 bits. What would round to 512 stays
    // at 511, which is off by less than a step of the largest: with the next exponent, which the extension takes, the
    // other components would be off by as much of a step twice as large.
    const auto floor_log2 = [](float v) { return static_cast<int>(std::bit_cast<std::uint32_t>(v) >> 23) - 127; };
    const std::uint32_t exponent = static_cast<std::uint32_t>(std::max(floor_log2(largest), -16) + 16);
    const float steps = std::bit_cast<float>((127 + 24 - exponent) << 23);
    const auto rounded = [&](float v) { return std::min(nearest_whole(v * steps), 511u); };
    return rounded(r) | rounded(g) << 9 | rounded(b) << 18 | exponent << 27;
}

[[nodiscard]] constexpr Rgb rgb_from_rgb9e5(std::uint32_t packed) {
    const float step = std::bit_cast<float>((127 - 24 + (packed >> 27)) << 23);
    return {static_cast<float>(packed & 511) * step, static_cast<float>(packed >> 9 & 511) * step,
            static_cast<float>(packed >> 18 & 511) * step};
}

}  // namespace lobelia::texels
