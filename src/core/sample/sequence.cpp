// Owen-scrambled Sobol pairs, one at a time.
#include "core/sample/sequence.h"

namespace lobelia {

Pair pair_of(std::uint32_t mixed_key, std::uint32_t sample, std::uint32_t dimension_pair) {
    // The index is scrambled by the seed itself, so that pairs of different number are not aligned with each other.
    const std::uint32_t seed = mix(mixed_key, dimension_pair);
    const auto [a, b] = scrambled_sobol(sample, seed, seed);
    return {unit_float(a), unit_float(b)};
}

Pair pair(std::uint32_t key, std::uint32_t sample, std::uint32_t dimension_pair, std::uint32_t seed) {
    return pair_of(mix(key, seed), sample, dimension_pair);
}

}  // namespace lobelia
