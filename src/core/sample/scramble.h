// The bits of Owen-scrambled Sobol points: the one home of hash, scrambling and dimensions. sequence_pairs.cpp has them
// again in vector lanes, and a test holds the two to each other.
// Sobol 1967; Laine and Karras 2011; Burley 2020; hashes after Wellons 2018.
#pragma once

#include <cstdint>

namespace lobelia {

/// A hash of two numbers, uniform over 32 bits.
[[nodiscard]] constexpr std::uint32_t mix(std::uint32_t value, std::uint32_t salt) {
    std::uint32_t x = value + 0x9e3779b9u * (salt + 1);
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0x735a2d97u;
    return x ^ (x >> 15);
}

[[nodiscard]] constexpr std::uint32_t reverse_bits(std::uint32_t v) {
    v = (v >> 16) | (v << 16);
    v = ((v & 0x00ff00ffu) << 8) | ((v & 0xff00ff00u) >> 8);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v & 0xf0f0f0f0u) >> 4);
    v = ((v & 0x33333333u) << 2) | ((v & 0xccccccccu) >> 2);
    return ((v & 0x55555555u) << 1) | ((v & 0xaaaaaaaau) >> 1);
}

/// Owen scrambling of a number whose bits are mirrored: the Laine-Karras permutation with Burley's constants.
[[nodiscard]] constexpr std::uint32_t scramble_mirrored(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    return v ^ v * 0x53a22864u;
}

/// The second Sobol dimension of an index, mirrored: the index times Pascal's triangle modulo 2, whose 2^k-th power
/// structure makes it five shifted sums.
[[nodiscard]] constexpr std::uint32_t second_dimension_mirrored(std::uint32_t index) {
    index ^= (index >> 16);
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    return index ^ (index & 0xaaaaaaaau) >> 1;
}

/// Point `sample` of the first two Sobol dimensions, 32 bits of each. The index is scrambled, too, by `order`: that
/// keeps each aligned block of 2^k points together, in another order.
struct SobolBits {
    std::uint32_t a, b;
};
[[nodiscard]] constexpr SobolBits scrambled_sobol(std::uint32_t sample, std::uint32_t order, std::uint32_t seed) {
    const std::uint32_t index = reverse_bits(scramble_mirrored(reverse_bits(sample), order));
    // The first dimension is the mirrored index, hence its scrambling begins with the index itself.
    return {reverse_bits(scramble_mirrored(index, mix(seed, 1))),
            reverse_bits(scramble_mirrored(second_dimension_mirrored(index), mix(seed, 2)))};
}

}  // namespace lobelia
