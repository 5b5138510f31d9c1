// BC6H: blocks of 4 x 4 half-float colours in 16 bytes. Khronos Data Format Specification 1.3, "BPTC"; Direct3D 11.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lobelia::bc6h {

inline constexpr std::size_t k_texels = 16;
inline constexpr std::size_t k_block_bytes = 16;

/// Whether a block holds halves >= 0 or halves of both signs; the texture's format says so, not the block.
enum class Signedness { unsigned_halves, signed_halves };

/// Bits of the halves R, G, B of each texel, row by row.
using Halves = std::array<std::array<std::uint16_t, 3>, k_texels>;

/// Decodes any 16 bytes, all 14 modes; the reserved ones are black.
[[nodiscard]] Halves decode_block(const std::byte* block, Signedness sign);

/// Encodes `blocks` blocks side by side from three channels with `stride` floats from row to row. Errors are weighed as
/// those of the square roots of the values; no value is further off than its block's range in its widest channel.
void encode_blocks(const float* const* channels, std::size_t stride, std::size_t blocks, Signedness sign,
                   std::byte* out);

}  // namespace lobelia::bc6h
