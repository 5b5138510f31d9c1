// Rounding of values that are not negative.
#pragma once

#include <cstdint>

namespace lobelia::texels {

/// The whole number nearest to v in [0, 2^23], halves up. In arithmetic that every instruction set has for vectors.
[[nodiscard]] constexpr std::uint32_t nearest_whole(float v) {
    constexpr float k_half = 0.5f;
    return static_cast<std::uint32_t>(v + k_half);
}

}  // namespace lobelia::texels
