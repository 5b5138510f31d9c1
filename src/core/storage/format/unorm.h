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

/// A byte for each of one, two or four channels.
void encode_unorm8(std::size_t channels, const float* const* in, std::size_t count, std::byte* out);
void decode_unorm8(std::size_t channels, const std::byte* bytes, std::size_t count, float* const* out);

/// Three channels of 10 bits, the first lowest; the upper two bits are set.
void encode_unorm10(const float* const* in, std::size_t count, std::byte* out);
void decode_unorm10(const std::byte* bytes, std::size_t count, float* const* out);

}  // namespace lobelia::texels
