// Texels of one, two or four channels as float32 or float16, and the largest magnitude of floats.
#pragma once

#include <cstddef>

#include "core/math/half.h"

namespace lobelia::texels {

// Kernels, as in all headers of texel formats: `count` is a multiple of k_lanes, bytes are aligned to 4.

/// Floats as they are, interleaved.
void encode_floats(std::size_t channels, const float* const* in, std::size_t count, std::byte* out);
void decode_floats(std::size_t channels, const std::byte* bytes, std::size_t count, float* const* out);

/// Halves as half_from_float() rounds them, interleaved; what is not finite becomes the largest.
void encode_halves(std::size_t channels, const float* const* in, std::size_t count, std::byte* out);
void decode_halves(std::size_t channels, const std::byte* bytes, std::size_t count, float* const* out);

/// The largest magnitude of `count` values.
[[nodiscard]] float largest_magnitude(const float* values, std::size_t count);

}  // namespace lobelia::texels
