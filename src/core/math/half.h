// Between float32 and IEEE 754 binary16.
#pragma once

#include <bit>
#include <cstdint>

namespace lobelia {

/// The largest finite half.
inline constexpr float k_largest_half = 65504;
/// Half floats are multiples of 2^-24. What is no larger than this is dim: of its values, those below a ten-thousandth
/// of the largest would vanish.
inline constexpr float k_dim_for_half = 0x1p-10f;

/// `value` rounded to nearest, ties to even; magnitudes beyond 65504 become 65504, NaN stays NaN.
[[nodiscard]] constexpr std::uint16_t half_from_float(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000, magnitude = bits & 0x7fffffff;
    constexpr std::uint32_t infinity = 0x7f800000, largest = 0x477fe000 /* 65504 */,
                            least_normal = 0x38800000 /* 2^-14 */;
    std::uint32_t half = 0;
    if (magnitude > infinity) {
        half = 0x7e00;
    } else if (magnitude >= largest) {
        half = 0x7bff;
    } else if (magnitude >= least_normal) {
        // Rebias the exponent from 127 to 15, and round the 13 bits that go; a carry moves into the exponent as it
        // should.
        const std::uint32_t rebiased = magnitude - ((127 - 15) << 23);
        half = (rebiased + 0xfff + (rebiased >> 13 & 1)) >> 13;
    } else {
        // Add 1/2, whose last mantissa bit weighs 2^-24, the least subnormal half: the addition itself rounds.
        half =
            std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) - std::bit_cast<std::uint32_t>(0.5f);
    }
    return static_cast<std::uint16_t>(sign | half);
}

/// The float that a half is, exactly; infinity and NaN stay what they are.
[[nodiscard]] constexpr float float_from_half(std::uint16_t half) {
    const std::uint32_t sign = std::uint32_t{half} << 16 & 0x80000000, exponent = half >> 10 & 31,
                        shifted = (half & 0x7fffu) << 13;
    std::uint32_t bits = 0;
    if (exponent == 31)
        bits = shifted + ((255 - 31) << 23);
    else if (exponent != 0)
        bits = shifted + ((127 - 15) << 23);
    else
        // A subnormal: a mantissa in units of 2^-24.
        bits = std::bit_cast<std::uint32_t>(static_cast<float>(half & 0x3ff) * 0x1p-24f);
    return std::bit_cast<float>(sign | bits);
}

}  // namespace lobelia
