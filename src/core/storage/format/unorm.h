// Texels whose channels are numbers of 8 or 10 bits that stand for [0, 1].
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/storage/format/nearest_whole.h"

namespace lobelia::texels {

/// The nearest of the numbers 0 .. steps to value * steps; values are cut to [0, 1].
[[nodiscard]] constexpr std::uint32_t unorm_from_float(float value, std::uint32_t steps) {
    return nearest_whole(std::min(std::max(value, 0.0f), 1.0f) * static_cast<float>(steps));
}
[[nodiscard]] constexpr float float_from_unorm(std::uint32_t stored, std::uint32_t steps) {
    return static_cast<float>(stored) / static_cast<float>(steps);
}

}  // namespace lobelia::texels
