// Tests that Sobol pairs cover the square evenly at any count, and that single and vector evaluation agree.
#include "core/sample/sequence.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "support.h"

namespace lobelia {
namespace {

/// Points [first, first + 2^bits) of a pair: each box of 2^-i x 2^-(bits - i) holds exactly one.
void expect_net(std::uint32_t key, std::uint32_t first, int bits, std::uint32_t dimension_pair) {
    const std::uint32_t count = 1u << bits;
    for (int i = 0; i <= bits; ++i) {
        std::vector<int> hits(count);
        for (std::uint32_t s = first; s < first + count; ++s) {
            const Pair p = pair(key, s, dimension_pair, 3);
            const auto x = static_cast<std::size_t>(std::ldexp(p.a, i)),
                       y = static_cast<std::size_t>(std::ldexp(p.b, bits - i));
            ++hits[(y << i) + x];
        }
        EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](int n) { return n == 1; })) << first << " 2^-" << i;
    }
}

TEST(Sequence, AlignedBlocksAreNets) {
    for (const std::uint32_t pair_number : {0u, 1u, 35u})
        for (const auto& [first, bits] : {std::pair{0u, 8}, {64u, 6}, {1u << 20, 10}, {48u, 4}})
            expect_net(17, first, bits, pair_number);
}

TEST(Sequence, ValuesAreInTheUnitSquare) {
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const Pair p = pair(i, i * 7, i % 40, 1);
        ASSERT_TRUE(p.a >= 0 && p.a < 1 && p.b >= 0 && p.b < 1);
    }
    EXPECT_LT(unit_float(0xffffffffu), 1);
}

/// Chi-square of two numbers over 16 x 16 cells.
template <class Draw>
void expect_independent(const Draw& draw, const char* what) {
    constexpr std::size_t n = 16, count = 200000;
    std::vector<double> hits(n * n);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Pair p = draw(i);
        ++hits[static_cast<std::size_t>(p.a * n) * n + static_cast<std::size_t>(p.b * n)];
    }
    const double expected = static_cast<double>(count) / (n * n);
    double chi_square = 0;
    for (const double h : hits) chi_square += (h - expected) * (h - expected) / expected;
    EXPECT_LT(chi_square, test::chi_square_limit(n * n - 1)) << what;
}

TEST(Sequence, PairsKeysAndSeedsAreIndependent) {
    expect_independent([](std::uint32_t i) { return Pair{pair(i, 5, 1, 1).a, pair(i, 5, 2, 1).a}; }, "pairs");
    expect_independent([](std::uint32_t i) { return Pair{pair(i, 5, 1, 1).a, pair(i + 1, 5, 1, 1).a}; }, "keys");
    expect_independent([](std::uint32_t i) { return Pair{pair(i, 5, 1, 1).b, pair(i, 5, 1, 2).b}; }, "seeds");
    expect_independent([](std::uint32_t i) { return pair(i, 0, 0, 1); }, "the two of a pair");
    expect_independent([](std::uint32_t i) { return Pair{unit_float(mix(i, 3)), unit_float(mix(i + 1, 3))}; }, "mix");
    expect_independent([](std::uint32_t i) { return Pair{unit_float(mix(7, i)), unit_float(mix(7, i + 1))}; }, "salt");
}

TEST(Sequence, VectorsGiveTheSameBits) {
    constexpr std::size_t count = 64;
    std::vector<std::uint32_t> keys(count), samples(count);
    for (std::uint32_t i = 0; i < count; ++i) keys[i] = mix(i, 9), samples[i] = i * i * 1009;
    Pairs many(count);
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        for (const std::uint32_t number : {0u, 1u, 40u}) {
            pairs_of(keys, samples, number, many);
            for (std::size_t i = 0; i < count; ++i) {
                const Pair one = pair_of(keys[i], samples[i], number);
                ASSERT_EQ(many.a[i], one.a) << hwy::TargetName(target);
                ASSERT_EQ(many.b[i], one.b) << hwy::TargetName(target);
            }
        }
    }
    hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace lobelia
