// RGBE: three mantissas and an exponent of a byte each, all >= 0. Ward 1991; but rounded to nearest, not down.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/storage/format/nearest_whole.h"
#include "lobelia/math.h"

namespace lobelia::texels {

/// 255 * 2^119.
inline constexpr float k_largest_rgbe = 255 * 0x1p119f;
/// What is less than this in all components is stored as black: all powers of two that occur are then normal floats.
inline constexpr float k_least_rgbe = 0x1p-100f;

/// A component is mantissa * 2^(exponent - 136), as in Radiance's pictures; an exponent of 0 is black. Red is lowest.
[[nodiscard]] constexpr std::uint32_t rgbe_from(Rgb c) {
    const auto cut = [](float v) { return std::min(std::max(v, 0.0f), k_largest_rgbe); };
    const float r = cut(c.r), g = cut(c.g), b = cut(c.b), largest = std::max({r, g, b});
    if (largest < k_least_rgbe) return 0;

    // The largest mantissa is 128 to 255. What would round to 256 stays at 255, which is off by less than a step of the
    // largest: with the next exponent the other components would be off by as much of a step twice as large.
    const std::uint32_t exponent = (std::bit_cast<std::uint32_t>(largest) >> 23) + 2;
    const float steps = std::bit_cast<float>((127 + 136 - exponent) << 23);
    const auto rounded = [&](float v) { return std::min(nearest_whole(v * steps), 255u); };
    return rounded(r) | rounded(g) << 8 | rounded(b) << 16 | exponent << 24;
}

[[nodiscard]] constexpr Rgb rgb_from_rgbe(std::uint32_t packed) {
    // Halve the power twice, so that the steps of the least exponents are normal floats.
    const std::uint32_t exponent = packed >> 24;
    if (exponent == 0) return {};
    const float root = std::bit_cast<float>((127 - 68 + exponent / 2) << 23);
    const float step = root * std::bit_cast<float>((127 - 68 + exponent - exponent / 2) << 23);
    return {static_cast<float>(packed & 255) * step, static_cast<float>(packed >> 8 & 255) * step,
            static_cast<float>(packed >> 16 & 255) * step};
}

}  // namespace lobelia::texels
