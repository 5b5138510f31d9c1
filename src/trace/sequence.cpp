// Owen-scrambled Sobol pairs: Sobol 1967, Laine and Karras 2011, Burley 2020.
#include "trace/sequence.h"

namespace lobelia {
namespace {

constexpr std::uint32_t reverse_bits(std::uint32_t v) {
    v = (v >> 16) | (v << 16);
    v = ((v & 0x00ff00ffu) << 8) | ((v & 0xff00ff00u) >> 8);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v & 0xf0f0f0f0u) >> 4);
    v = ((v & 0x33333333u) << 2) | ((v & 0xccccccccu) >> 2);
    return ((v & 0x55555555u) << 1) | ((v & 0xaaaaaaaau) >> 1);
}

/// The Laine-Karras permutation with Burley's constants: Owen scrambling of a number whose bits are mirrored.
constexpr std::uint32_t scramble_mirrored(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    return v ^ v * 0x53a22864u;
}

/// The second Sobol dimension of an index, mirrored: the index times Pascal's triangle modulo 2, whose 2^k-th power
/// structure makes it five shifted sums.
constexpr std::uint32_t second_dimension_mirrored(std::uint32_t index) {
    index ^= (index >> 16);
    index ^= (index & 0xff00ff00u) >> 8;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xccccccccu) >> 2;
    return index ^ (index & 0xaaaaaaaau) >> 1;
}

}  // namespace

Pair pair_of(std::uint32_t mixed_key, std::uint32_t sample, std::uint32_t dimension_pair) {
    const std::uint32_t seed = mix(mixed_key, dimension_pair);
    // Shuffle the index by scrambling it, so that pairs of different number are not aligned with each other.
    const std::uint32_t index = reverse_bits(scramble_mirrored(reverse_bits(sample), seed));
    // The first dimension is the mirrored index, hence the index itself is what its scrambling begins with.
    const std::uint32_t a = reverse_bits(scramble_mirrored(index, mix(seed, 1)));
    const std::uint32_t b = reverse_bits(scramble_mirrored(second_dimension_mirrored(index), mix(seed, 2)));
    return {unit_float(a), unit_float(b)};
}

Pair pair(std::uint32_t key, std::uint32_t sample, std::uint32_t dimension_pair, std::uint32_t seed) {
    return pair_of(mix(key, seed), sample, dimension_pair);
}

}  // namespace lobelia
