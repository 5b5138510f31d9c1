// Counter-based Owen-scrambled Sobol points: any pair of dimensions of any point of any receiver, in no order.
// Burley 2020.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/sample/scramble.h"

namespace lobelia {

/// A point of the unit square [0, 1)^2 in multiples of 2^-24.
struct Pair {
    float a = 0, b = 0;
};

/// 32 uniform bits as a number in [0, 1).
[[nodiscard]] constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// Point `sample` of pair number `dimension_pair`, in the sequence of `key`. Within one pair and key, each aligned
/// block of 2^k samples is a (0, k, 2)-net; different pairs, keys and seeds are independent scramblings.
[[nodiscard]] Pair pair(std::uint32_t key, std::uint32_t sample, std::uint32_t dimension_pair, std::uint32_t seed);

/// The same with `mixed_key` = mix(key, seed), for repeated calls.
[[nodiscard]] Pair pair_of(std::uint32_t mixed_key, std::uint32_t sample, std::uint32_t dimension_pair);

/// Many points: a[i], b[i].
struct Pairs {
    std::vector<float> a, b;
    explicit Pairs(std::size_t size) : a(size), b(size) {}
    [[nodiscard]] Pair operator[](std::size_t i) const { return {a[i], b[i]}; }
};

/// The first of `out`: for each of `mixed_keys`, point samples[i]; the same bits as pair_of. Precondition: their number
/// is a multiple of k_lanes.
void pairs_of(std::span<const std::uint32_t> mixed_keys, std::span<const std::uint32_t> samples,
              std::uint32_t dimension_pair, Pairs& out);

}  // namespace lobelia
