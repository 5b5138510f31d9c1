// Tests that samplers agree with their pdfs and inverses, that sequences cover the square evenly, that draws are
// unbiased.
#include "lobelia/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "core/sample/directions.h"
#include "support.h"

namespace lobelia {
namespace {

template <class Sampler>
class Samplers : public ::testing::Test {};
using AllSamplers = ::testing::Types<UniformSphere, UniformHemisphere, CosineHemisphere>;
TYPED_TEST_SUITE(Samplers, AllSamplers);

TYPED_TEST(Samplers, SampleToInverseRoundTrip) {
    for (double a = 0.005; a < 1; a += 0.045) {
        for (double b = 0.0051; b < 1; b += 0.0307) {
            const Vec3 d = TypeParam::sample({a, b});
            const Point2 p = TypeParam::inverse(d);
            EXPECT_NEAR(length(d), 1, 2e-7);
            // Components are rounded by 6e-8 at most; the factor is 1 / r in the azimuth, and 2 at most in a.
            const double r = std::hypot(d.x, d.y);
            EXPECT_NEAR(p.a, a, 1.3e-7);
            EXPECT_NEAR(p.b, b, 6e-8 / r) << a;
        }
    }
}

TYPED_TEST(Samplers, SampleStaysInDomainAtTheEdges) {
    const double last = 1 - 0x1p-53;
    for (const double a : {0.0, last})
        for (const double b : {0.0, 0.25, 0.5, last}) {
            const Vec3 d = TypeParam::sample({a, b});
            EXPECT_NEAR(length(d), 1, 2e-7);
            if (TypeParam::domain == Domain::hemisphere) {
                EXPECT_GE(d.z, 0);
            }
        }
}

TYPED_TEST(Samplers, PdfIntegratesToOne) {
    const SphereRule rule = product_rule(TypeParam::domain, 16);
    double sum = 0;
    for (std::size_t i = 0; i < rule.weights.size(); ++i) {
        const Vec3 d = direction_at(rule.directions, i);
        sum += rule.weights[i] * TypeParam::pdf(d);
        if (TypeParam::domain == Domain::hemisphere) {
            EXPECT_EQ(TypeParam::pdf({d.x, d.y, -d.z}), 0);
        }
    }
    EXPECT_NEAR(sum, 1, 1e-7);
}

/// Chi-square against the density over cells of height and azimuth; it fails by chance once in 10^4 seeds.
TYPED_TEST(Samplers, ChiSquareOfSamplesAgainstPdf) {
    constexpr std::size_t heights = 20, azimuths = 16, count = 200000;
    std::vector<double> observed(heights * azimuths);
    std::mt19937 generator(1);
    const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
    for (std::size_t i = 0; i < count; ++i) {
        const double a = uniform(), b = uniform();
        const Vec3 d = TypeParam::sample({a, b});
        const double turn = (std::atan2(d.y, d.x) / k_pi + 1) / 2;
        const auto cell = [](double t, std::size_t n) {
            return std::clamp<std::size_t>(static_cast<std::size_t>(std::max(0.0, t) * static_cast<double>(n)), 0,
                                           n - 1);
        };
        observed[cell((d.z + 1.0) / 2, heights) * azimuths + cell(turn, azimuths)] += 1;
    }

    // Integrate the density over each cell; it depends on the height only.
    double chi_square = 0;
    std::size_t cells = 0;
    for (std::size_t h = 0; h < heights; ++h) {
        const double step = 2.0 / heights, low = -1 + static_cast<double>(h) * step;
        const GaussLegendre rule(8, low, low + step);
        double expected = 0;
        for (std::size_t q = 0; q < 8; ++q) {
            const double z = rule.nodes[q];
            expected +=
                rule.weights[q] * TypeParam::pdf({static_cast<float>(std::sqrt(1 - z * z)), 0, static_cast<float>(z)});
        }
        expected *= 2 * k_pi / azimuths * count;
        for (std::size_t a = 0; a < azimuths; ++a) {
            const double seen = observed[h * azimuths + a];
            if (expected == 0) {
                EXPECT_EQ(seen, 0) << "height " << low;
                continue;
            }
            chi_square += (seen - expected) * (seen - expected) / expected;
            ++cells;
        }
    }
    EXPECT_LT(chi_square, test::chi_square_limit(cells - 1)) << cells << " cells";
}

TEST(Sequences, PointsLieInTheUnitSquare) {
    for (const Sequence sequence : k_sequences)
        for (const std::size_t count : {1, 2, 7, 1000, 4096})
            for (const std::uint32_t seed : {0u, 1u, 12345u, 0xffffffffu}) {
                const auto points = sequence_points(sequence, count, seed);
                ASSERT_EQ(points.size(), count);
                for (const Point2 p : points) {
                    ASSERT_TRUE(p.a >= 0 && p.a < 1 && p.b >= 0 && p.b < 1) << sequence_name(sequence);
                }
            }
    for (const Sequence sequence : k_sequences) EXPECT_TRUE(sequence_points(sequence, 0, 1).empty());
}

TEST(Sequences, SameSeedSamePointsOtherSeedOtherPoints) {
    const auto equal = [](const std::vector<Point2>& a, const std::vector<Point2>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](Point2 p, Point2 q) { return p.a == q.a && p.b == q.b; });
    };
    for (const Sequence sequence : k_sequences) {
        const bool seedless = sequence == Sequence::hammersley || sequence == Sequence::halton;
        const auto points = sequence_points(sequence, 500, 3);
        EXPECT_TRUE(equal(points, sequence_points(sequence, 500, 3))) << sequence_name(sequence);
        EXPECT_EQ(equal(points, sequence_points(sequence, 500, 4)), seedless) << sequence_name(sequence);
    }
}

TEST(Sequences, NamesRoundTrip) {
    std::set<std::string_view> names;
    for (const Sequence sequence : k_sequences) {
        EXPECT_EQ(sequence_from_name(sequence_name(sequence)), sequence);
        names.insert(sequence_name(sequence));
    }
    EXPECT_EQ(names.size(), k_sequences.size());
    EXPECT_FALSE(sequence_from_name("sobolev"));
}

/// e^a sin^2(pi b), whose integral is (e - 1) / 2: smooth, and not special to any of the sequences.
double integration_error(const std::vector<Point2>& points) {
    double sum = 0;
    for (const Point2 p : points) sum += std::exp(p.a) * std::pow(std::sin(k_pi * p.b), 2);
    return sum / static_cast<double>(points.size()) - (std::exp(1.0) - 1) / 2;
}

double rms_integration_error(Sequence sequence, std::size_t count) {
    constexpr int seeds = 32;
    double squares = 0;
    for (std::uint32_t seed = 0; seed < seeds; ++seed)
        squares += std::pow(integration_error(sequence_points(sequence, count, seed)), 2);
    return std::sqrt(squares / seeds);
}

TEST(Sequences, LowDiscrepancyBeatsRandom) {
    for (const std::size_t count : {256, 1000, 4096}) {
        const double random = rms_integration_error(Sequence::random, count);
        for (const Sequence sequence : k_sequences) {
            if (sequence != Sequence::random) {
                EXPECT_LT(rms_integration_error(sequence, count), random / 4) << sequence_name(sequence) << count;
            }
        }
    }
}

TEST(Sequences, RandomErrsAsItsVarianceSays) {
    // Var = integral of f^2 - (integral of f)^2 = 3 (e^2 - 1) / 16 - ((e - 1) / 2)^2. The mean of 32 squared errors is
    // chi-square of 32 degrees over 32: within [0.25, 2.5] but for a chance below 1e-4.
    const double e = std::exp(1.0), variance = 3 * (e * e - 1) / 16 - std::pow((e - 1) / 2, 2);
    const double ratio = std::pow(rms_integration_error(Sequence::random, 1000), 2) / (variance / 1000);
    EXPECT_GT(ratio, 0.25);
    EXPECT_LT(ratio, 2.5);
}

TEST(Sequences, StratifiedHasOnePointPerCell) {
    for (const std::size_t side : {1, 4, 32}) {
        std::set<std::pair<int, int>> cells;
        for (const Point2 p : sequence_points(Sequence::stratified, side * side, 5))
            cells.emplace(static_cast<int>(p.a * static_cast<double>(side)),
                          static_cast<int>(p.b * static_cast<double>(side)));
        EXPECT_EQ(cells.size(), side * side);
    }
}

/// Every elementary interval of area 2^-m holds exactly one of the 2^m points.
void expect_net(std::span<const Point2> points, const char* what) {
    const auto m = static_cast<int>(std::log2(static_cast<double>(points.size())));
    for (int k = 0; k <= m; ++k) {
        std::set<std::pair<long, long>> cells;
        for (const Point2 p : points)
            cells.emplace(static_cast<long>(std::ldexp(p.a, k)), static_cast<long>(std::ldexp(p.b, m - k)));
        EXPECT_EQ(cells.size(), points.size()) << what << ": intervals of 2^-" << k << " by 2^-" << m - k;
    }
}

TEST(Sequences, SobolIsANetAtPowersOfTwo) {
    for (const std::uint32_t seed : {0u, 1u, 2u, 77u, 0xdeadbeefu})
        for (int m = 0; m <= 12; ++m) {
            SCOPED_TRACE(testing::Message() << "seed " << seed);
            expect_net(sequence_points(Sequence::sobol, std::size_t{1} << m, seed), "first points");
        }
}

TEST(Sequences, SobolIsANetInEveryAlignedPart) {
    const auto points = sequence_points(Sequence::sobol, 1024, 9);
    for (std::size_t begin = 0; begin < 1024; begin += 64) expect_net(std::span(points).subspan(begin, 64), "part");
}

TEST(Sequences, HammersleyIsANetAndStartsAsKnown) {
    const auto points = sequence_points(Sequence::hammersley, 4, 0);
    const double known[4][2] = {{0, 0}, {0.25, 0.5}, {0.5, 0.25}, {0.75, 0.75}};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(points[i].a, known[i][0]);
        EXPECT_EQ(points[i].b, known[i][1]);
    }
    expect_net(sequence_points(Sequence::hammersley, 256, 0), "hammersley");
}

TEST(Sequences, HaltonStartsAsKnown) {
    const auto points = sequence_points(Sequence::halton, 9, 0);
    const double known[9][2] = {{1. / 2, 1. / 3}, {1. / 4, 2. / 3},  {3. / 4, 1. / 9},
                                {1. / 8, 4. / 9}, {5. / 8, 7. / 9},  {3. / 8, 2. / 9},
                                {7. / 8, 5. / 9}, {1. / 16, 8. / 9}, {9. / 16, 1. / 27}};
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(points[i].a, known[i][0], 1e-15);
        EXPECT_NEAR(points[i].b, known[i][1], 1e-15);
    }
}

TEST(Sequences, R2StepsByThePlasticNumber) {
    const auto points = sequence_points(Sequence::r2, 1000, 8);
    const auto step = [](double from, double to) { return to - from - std::floor(to - from); };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        EXPECT_NEAR(step(points[i].a, points[i + 1].a), 0.7548776662466927, 1e-12);
        EXPECT_NEAR(step(points[i].b, points[i + 1].b), 0.5698402909980532, 1e-12);
    }
}

TEST(Sequences, RadicalInverseMirrorsBits) {
    EXPECT_EQ(radical_inverse_2(0), 0);
    EXPECT_EQ(radical_inverse_2(1), 0.5);
    EXPECT_EQ(radical_inverse_2(6), 0.375);
    EXPECT_EQ(radical_inverse_2(0x80000000u), 0x1p-32);
    EXPECT_EQ(radical_inverse_2(0xffffffffu), 1 - 0x1p-32);
}

TEST(UniformDirections, CoverTheirDomainEvenly) {
    for (const Sequence sequence : k_sequences)
        for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
            const Directions d = uniform_directions(domain, sequence, 4096, 2);
            double z = 0, z2 = 0, x = 0;
            for (std::size_t i = 0; i < d.size(); ++i) {
                z += d.channel(2)[i] / 4096.0;
                z2 += std::pow(d.channel(2)[i], 2) / 4096.0;
                x += d.channel(0)[i] / 4096.0;
            }
            // Independent points: standard deviations 0.009, 0.0047 and 0.009; 4.5 of them, chance below 1e-5 each.
            EXPECT_NEAR(z, domain == Domain::sphere ? 0 : 0.5, 0.041) << sequence_name(sequence);
            EXPECT_NEAR(z2, 1.0 / 3, 0.022) << sequence_name(sequence);
            EXPECT_NEAR(x, 0, 0.041) << sequence_name(sequence);
        }
}

TEST(Shuffle, IsAPermutation) {
    std::mt19937 generator(3);
    for (const std::size_t count : {0, 1, 2, 3, 64, 1000}) {
        auto order = shuffled_order(count, generator);
        std::sort(order.begin(), order.end());
        std::vector<std::uint32_t> identity(count);
        std::iota(identity.begin(), identity.end(), 0u);
        EXPECT_EQ(order, identity);
    }
}

TEST(Shuffle, MatchesTheDrawsWorkedByHand) {
    // mt19937 with its default seed gives 3499211612 581869302 3890346734 3586334585 545404204 4161255391 3922919429
    // 949333985 2715962298 1323567403 418932835 2350294565 1196140740. Five cards: draws 4 (of 0..4), 2 (of 0..3), 2
    // (of 0..2), 1 (of 0..1). Six more, from the fifth output on: 4; 7 and 5 rejected, 1; 2; 3 and 3 rejected, 1; 0.
    std::mt19937 generator;
    EXPECT_EQ(shuffled_order(5, generator), (std::vector<std::uint32_t>{4, 3, 0, 2, 1}));
    EXPECT_EQ(shuffled_order(6, generator), (std::vector<std::uint32_t>{4, 2, 0, 1, 3, 5}));
}

/// All 24 orders of four cards are equally likely: chi-square, significance 1e-4.
TEST(Shuffle, IsUnbiased) {
    std::mt19937 generator(17);
    std::map<std::vector<std::uint32_t>, double> seen;
    constexpr int rounds = 24000;
    for (int i = 0; i < rounds; ++i) seen[shuffled_order(4, generator)] += 1;
    ASSERT_EQ(seen.size(), 24u);
    double chi_square = 0;
    for (const auto& [order, count] : seen) chi_square += std::pow(count - rounds / 24.0, 2) / (rounds / 24.0);
    EXPECT_LT(chi_square, test::chi_square_limit(23));
}

TEST(Shuffle, SpreadOrderIsAPermutationOfWhichEveryBeginningIsSpread) {
    for (const std::size_t count : {0, 1, 2, 3, 64, 1000})
        for (const std::uint32_t seed : {0u, 1u, 99u}) {
            const auto order = spread_order(count, seed);
            EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), count);
            for (const std::uint32_t place : order) EXPECT_LT(place, count);
            EXPECT_EQ(order, spread_order(count, seed));
        }
    // The first 2^k of 1024 places fall into 2^k different parts.
    const auto order = spread_order(1024, 7);
    for (std::size_t parts = 1; parts <= 1024; parts *= 2) {
        std::set<std::size_t> seen;
        for (std::size_t i = 0; i < parts; ++i) seen.insert(order[i] * parts / 1024);
        EXPECT_EQ(seen.size(), parts);
    }
}

TEST(Shuffle, ReorderedPutsEachSampleInItsPlace) {
    Samples samples(37);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto f = static_cast<float>(i);
        samples.set(i, {{f, f + 0.1f, f + 0.2f}, {f + 0.3f, f + 0.4f, f + 0.5f}, f + 0.6f});
    }
    std::mt19937 generator(5);
    const auto order = shuffled_order(samples.size(), generator);
    const Samples result = reordered(samples, order);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(result[i].direction, samples[order[i]].direction);
        EXPECT_EQ(result[i].radiance, samples[order[i]].radiance);
        EXPECT_EQ(result[i].solid_angle, samples[order[i]].solid_angle);
    }
}

/// Computes the probability of each index: bisects where each column changes from itself to its alias.
std::vector<double> enumerated(const AliasTable& table) {
    const double share = 1.0 / static_cast<double>(table.size());
    std::vector<double> probability(table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        const std::size_t alias = table.choose(i, 1 - 0x1p-53);
        double low = 0, high = 1;
        if (alias == i) {
            low = 1;
        } else {
            for (int step = 0; step < 53; ++step) {
                const double middle = (low + high) / 2;
                (table.choose(i, middle) == i ? low : high) = middle;
            }
        }
        probability[i] += share * low;
        probability[alias] += share * (1 - low);
    }
    return probability;
}

TEST(AliasTable, ProbabilitiesAreTheWeightsByEnumeration) {
    std::mt19937 generator(23);
    std::vector<std::vector<float>> cases = {{1}, {0, 1}, {1, 1, 1, 1}, {0, 0, 5, 0}, {1e-6f, 1, 1e6f}};
    for (const std::size_t size : {2, 3, 17, 300}) {
        std::vector<float> weights(size);
        for (float& w : weights) w = std::pow(static_cast<float>(generator()) * 0x1p-32f, 4.0f);
        cases.push_back(weights);
    }
    for (const auto& weights : cases) {
        const AliasTable table(weights);
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        const auto probability = enumerated(table);
        double sum = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) {
            // Thresholds are float32, and the rest of a column is passed from column to column.
            EXPECT_NEAR(probability[i], weights[i] / total, 1e-6) << i << " of " << weights.size();
            EXPECT_NEAR(table.probability(i), weights[i] / total, 1e-6);
            sum += probability[i];
        }
        EXPECT_NEAR(sum, 1, 1e-12);
    }
}

TEST(AliasTable, SampleSplitsThePointIntoColumnAndThreshold) {
    const AliasTable table(std::vector<float>{1, 2, 3, 10});
    for (std::size_t i = 0; i < 4; ++i)
        for (const double u : {0.001, 0.3, 0.6, 0.999})
            EXPECT_EQ(table.sample({(static_cast<double>(i) + 0.5) / 4, u}), table.choose(i, u));
    EXPECT_LT(table.sample({1 - 0x1p-53, 0.5}), 4u);
}

TEST(AliasTable, NeverChoosesWeightZero) {
    const AliasTable table(std::vector<float>{0, 3, 0, 1, 0});
    for (std::size_t i = 0; i < 5; ++i)
        for (const double u : {0x1p-32, 0.1, 0.5, 0.9, 1 - 0x1p-32}) {
            const std::size_t chosen = table.choose(i, u);
            EXPECT_TRUE(chosen == 1 || chosen == 3) << i << " at " << u;
        }
}

TEST(Directions, TheFastCosineMapEqualsTheExactOne) {
    for (const Point2 p : sequence_points(Sequence::sobol, 1000, 5)) {
        const Pair pair{static_cast<float>(p.a), static_cast<float>(p.b)};
        // The fast form takes the height from 1 - a, too, but its radius from a.
        EXPECT_LT(length(cosine_direction(pair) - CosineHemisphere::sample({pair.a, pair.b})), 2e-6f);
        // Near the poles sqrt(1 - z^2) has half of the digits of z.
        EXPECT_LT(length(around_z(1 - 2 * pair.a, pair.b) - UniformSphere::sample({pair.a, pair.b})), 4e-4f);
    }
}

}  // namespace
}  // namespace lobelia
