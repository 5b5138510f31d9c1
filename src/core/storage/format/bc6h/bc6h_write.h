// Puts the parts of a BC6H block together: quantised endpoints, a mode that can hold them, indices.
#pragma once

#include "core/storage/format/bc6h/bc6h.h"
#include "core/storage/format/bc6h/bc6h_modes.h"

namespace lobelia::bc6h {

/// Endpoints as numbers of 16 bits (unsigned) or 15 bits and a sign: what indices interpolate between.
using WideEndpoints = std::array<std::array<float, 3>, 4>;

/// A mode with endpoints quantised for it, differences not yet taken, and what they are unquantised.
struct Quantised {
    const Mode* mode = nullptr;
    Endpoints stored{};
    Endpoints wide{};
};

/// The most precise mode of this many regions whose differences hold the endpoints.
[[nodiscard]] Quantised quantised(const WideEndpoints& e, std::size_t regions, Signedness sign);

/// One region in the most precise mode, both of its ends these bits of halves: they are kept exactly.
[[nodiscard]] Quantised flat(const std::array<int, 3>& wide);

/// Writes a block; the indices of anchors lack their highest bit, which is 0.
void write_block(const Quantised& q, std::size_t partition, const std::array<std::uint8_t, k_texels>& indices,
                 std::byte* block);

}  // namespace lobelia::bc6h
