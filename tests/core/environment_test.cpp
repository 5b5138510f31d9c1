// Tests that latitude-longitude grids tile the sphere, that resizing keeps energy everywhere, and that the irradiance
// sum is exact.
#include "lobelia/environment.h"

#include <gtest/gtest.h>

#include "measure/comparison.h"
#include "support.h"

namespace lobelia {
namespace {

Image noise(std::size_t width, std::size_t height, std::uint32_t seed) {
    Image image(width, height);
    std::mt19937 generator(seed);
    const auto value = [&] { return std::exp2(static_cast<float>(generator() % 1000) * 0.01f - 5); };
    for (Rgb& pixel : image.pixels) {
        pixel.r = value();
        pixel.g = value();
        pixel.b = value();
    }
    return image;
}

Image constant(LatLong grid, Rgb value) {
    Image image(grid.width, grid.height);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

const std::vector<LatLong> k_grids = {{1, 1},   {2, 1},   {1, 2},    {3, 5},  {7, 3},   {8, 4},    {16, 8},
                                      {31, 17}, {64, 32}, {100, 50}, {5, 64}, {257, 3}, {256, 128}};

TEST(LatLong, TexelsRoundTrip) {
    for (const LatLong grid : k_grids)
        for (std::size_t i = 0; i < grid.size(); ++i) {
            ASSERT_EQ(grid.index(grid.direction(i)), i) << grid.width << " x " << grid.height;
            ASSERT_NEAR(length(grid.direction(i)), 1, 2e-7);
        }
}

TEST(LatLong, PositionsRoundTrip) {
    for (double u = 0.01; u < 1; u += 0.07)
        for (double v = 0.01; v < 1; v += 0.07) {
            const auto p = LatLong::position(LatLong::direction(u, v));
            // acos of a float32 loses 6e-8 / sin(pi v).
            EXPECT_NEAR(p.u, u, 1e-7 / std::sin(k_pi * v));
            EXPECT_NEAR(p.v, v, 1e-7 / std::sin(k_pi * v));
        }
}

TEST(LatLong, KnownDirections) {
    const auto expect = [](double u, double v, Vec3 expected) {
        EXPECT_LT(length(LatLong::direction(u, v) - expected), 1e-6) << u << " " << v;
    };
    expect(0.5, 0.5, {0, 0, -1});
    expect(0.75, 0.5, {1, 0, 0});
    expect(0.25, 0.5, {-1, 0, 0});
    expect(0, 0.5, {0, 0, 1});
    expect(1, 0.5, {0, 0, 1});
    expect(0.3, 0, {0, 1, 0});
    expect(0.3, 1, {0, -1, 0});
}

TEST(LatLong, EveryDirectionHasATexel) {
    const Directions directions = test::random_directions(Domain::sphere, 2000, 4);
    for (const LatLong grid : k_grids) {
        for (std::size_t i = 0; i < directions.size(); ++i)
            ASSERT_LT(grid.index(direction_at(directions, i)), grid.size());
        for (const Vec3 d : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{-0.0f, 0, 1},
                             Vec3{1e-30f, 0, 1}, Vec3{0, 1.0000001f, 0}})
            ASSERT_LT(grid.index(d), grid.size());
    }
}

TEST(LatLong, SolidAnglesSumToFourPi) {
    for (const LatLong grid : k_grids) {
        double sum = 0;
        for (const float omega : grid.solid_angles()) sum += omega;
        EXPECT_NEAR(sum, 4 * k_pi, 4e-7 * 4 * k_pi) << grid.width << " x " << grid.height;
    }
}

TEST(LatLong, TablesAgreeWithSingleTexels) {
    const LatLong grid{31, 17};
    const Directions directions = grid.directions();
    const auto solid_angles = grid.solid_angles();
    for (std::size_t i = 0; i < grid.size(); ++i) {
        EXPECT_LT(length(direction_at(directions, i) - grid.direction(i)), 2e-7);
        EXPECT_EQ(solid_angles[i], static_cast<float>(grid.solid_angle(i / grid.width)));
    }
}

/// Integral of each channel over the sphere.
std::array<double, 3> energy(const Image& image) {
    const LatLong grid = lat_long(image);
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const double omega = grid.solid_angle(i / grid.width);
        sum[0] += omega * image.pixels[i].r;
        sum[1] += omega * image.pixels[i].g;
        sum[2] += omega * image.pixels[i].b;
    }
    return sum;
}

TEST(Resize, EnergyIsKeptBetweenAnySizes) {
    for (const LatLong from : k_grids) {
        const Image source = noise(from.width, from.height, 1);
        const auto before = energy(source);
        for (const LatLong to : k_grids) {
            const Image result = resize(source, to);
            ASSERT_EQ(lat_long(result), to);
            const auto after = energy(result);
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(after[k], before[k], 1e-6 * before[k])
                    << from.width << " x " << from.height << " to " << to.width << " x " << to.height;
        }
    }
}

TEST(Resize, ConstantStaysConstantAndRangeIsKept) {
    for (const LatLong to : k_grids) {
        const Image flat = resize(constant({13, 9}, {2, 3, 4}), to);
        for (const Rgb& pixel : flat.pixels) {
            EXPECT_NEAR(pixel.r, 2, 1e-6);
            EXPECT_NEAR(pixel.b, 4, 2e-6);
        }
        for (const Rgb& pixel : resize(noise(13, 9, 2), to).pixels) {
            EXPECT_GE(pixel.g, 0.999f * std::exp2(-5.0f));
            EXPECT_LE(pixel.g, 1.001f * std::exp2(5.0f));
        }
    }
}

TEST(Resize, SplittingTexelsAndJoiningThemAgainRoundTrips) {
    const Image source = noise(12, 6, 3);
    for (const LatLong finer : {LatLong{24, 12}, LatLong{36, 6}, LatLong{12, 30}}) {
        const Image back = resize(resize(source, finer), {12, 6});
        for (std::size_t i = 0; i < source.pixels.size(); ++i)
            EXPECT_LT(test::norm(back.pixels[i] - source.pixels[i]), 1e-6 * test::norm(source.pixels[i]));
    }
}

Image rolled(const Image& image, std::size_t columns) {
    Image result(image.width, image.height);
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < image.width; ++x) result.at((x + columns) % image.width, y) = image.at(x, y);
    return result;
}

TEST(Resize, CommutesWithRollsOverTheSeam) {
    struct Case {
        LatLong from, to;
        std::size_t from_columns, to_columns;  ///< one and the same angle
    };
    for (const Case& c : {Case{{12, 6}, {4, 3}, 3, 1}, Case{{4, 3}, {12, 5}, 1, 3}, Case{{12, 6}, {8, 4}, 3, 2},
                          Case{{8, 5}, {12, 7}, 6, 9}, Case{{256, 4}, {96, 2}, 8, 3}}) {
        const Image source = noise(c.from.width, c.from.height, 4);
        const Image a = resize(rolled(source, c.from_columns), c.to), b = rolled(resize(source, c.to), c.to_columns);
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            EXPECT_LT(test::norm(a.pixels[i] - b.pixels[i]), 1e-6 * test::norm(b.pixels[i])) << c.from.width;
    }
}

TEST(Resize, WholeTexelsAreAveragedBySolidAngle) {
    const Image source = noise(6, 4, 5);
    const Image result = resize(source, {3, 2});
    const LatLong grid = lat_long(source);
    for (std::size_t y = 0; y < 2; ++y)
        for (std::size_t x = 0; x < 3; ++x) {
            double sum = 0, total = 0;
            for (std::size_t dy = 0; dy < 2; ++dy)
                for (std::size_t dx = 0; dx < 2; ++dx) {
                    sum += grid.solid_angle(2 * y + dy) * source.at(2 * x + dx, 2 * y + dy).r;
                    total += grid.solid_angle(2 * y + dy);
                }
            EXPECT_NEAR(result.at(x, y).r, sum / total, 1e-6 * sum / total);
        }
}

TEST(ReducedGrid, FitsKeepsAspectAndPrefersWholeNumbers) {
    EXPECT_EQ(reduced_grid({256, 128}, 131072), (LatLong{256, 128}));
    EXPECT_EQ(reduced_grid({512, 256}, 131072), (LatLong{512, 256}));
    EXPECT_EQ(reduced_grid({1024, 512}, 131072), (LatLong{512, 256}));
    EXPECT_EQ(reduced_grid({8192, 4096}, 131072), (LatLong{512, 256}));
    EXPECT_EQ(reduced_grid({3000, 1500}, 131072), (LatLong{500, 250}));
    EXPECT_EQ(reduced_grid({700, 700}, 131072), (LatLong{350, 350}));
    for (const LatLong grid : {LatLong{1001, 499}, LatLong{517, 259}, LatLong{4099, 2048}}) {
        const LatLong reduced = reduced_grid(grid, 131072);
        const double aspect = static_cast<double>(grid.width) / static_cast<double>(grid.height);
        EXPECT_LE(reduced.size(), 131072u);
        EXPECT_GT(reduced.size(), 131072u * 95 / 100) << grid.width;
        EXPECT_NEAR(static_cast<double>(reduced.width) / static_cast<double>(reduced.height), aspect, 0.01 * aspect);
    }
}

TEST(ReducedGrid, IsNeverEmptyAndNeverTooLarge) {
    for (const std::size_t most : {1, 2, 10, 1000, 131072})
        for (const LatLong grid : {LatLong{1, 1}, LatLong{100000, 1}, LatLong{1, 100000}, LatLong{200001, 1},
                                   LatLong{3, 99999}, LatLong{997, 991}, LatLong{1024, 512}}) {
            const LatLong reduced = reduced_grid(grid, most);
            EXPECT_GE(reduced.width, 1u) << grid.width << " x " << grid.height << " to " << most;
            EXPECT_GE(reduced.height, 1u) << grid.width << " x " << grid.height << " to " << most;
            EXPECT_LE(reduced.size(), most) << grid.width << " x " << grid.height;
            EXPECT_TRUE(reduced.width <= grid.width && reduced.height <= grid.height);
        }
}

TEST(DomainFrames, RoundTripAndTurnUpToZ) {
    const Directions directions = test::random_directions(Domain::sphere, 50, 8);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3 d = direction_at(directions, i);
        EXPECT_EQ(domain_from_world(Domain::sphere, d), d);
        for (const Domain domain : {Domain::sphere, Domain::hemisphere})
            EXPECT_EQ(world_from_domain(domain, domain_from_world(domain, d)), d);
    }
    EXPECT_EQ(domain_from_world(Domain::hemisphere, {0, 1, 0}), (Vec3{0, 0, 1}));
    // A rotation, not a reflection.
    const auto turned = [](Vec3 d) { return domain_from_world(Domain::hemisphere, d); };
    EXPECT_EQ(cross(turned({1, 0, 0}), turned({0, 1, 0})), turned({0, 0, 1}));
}

/// Returns the radiance of `image` in a direction of the domain.
Rgb seen(const Image& image, Domain domain, Vec3 direction) {
    return image.pixels[lat_long(image).index(world_from_domain(domain, direction))];
}

TEST(TexelSamples, CoverTheirDomainOnce) {
    for (const LatLong grid : {LatLong{64, 32}, LatLong{7, 6}, LatLong{2, 2}}) {
        const Image image = noise(grid.width, grid.height, 6);
        for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
            const Samples samples = texel_samples(image, domain);
            double total = 0;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                total += samples[i].solid_angle;
                EXPECT_TRUE(domain == Domain::sphere || samples[i].direction.z > 0);
                EXPECT_EQ(samples[i].radiance, seen(image, domain, samples[i].direction));
            }
            EXPECT_NEAR(total, solid_angle(domain), 1e-6 * solid_angle(domain));
        }
    }
}

TEST(TexelSamples, ShuffledAreTheSameTexelsInAnotherOrder) {
    const auto less = [](const RadianceSample& a, const RadianceSample& b) {
        const Vec3 p = a.direction, q = b.direction;
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    const auto sorted = [&](const Samples& samples) {
        std::vector<RadianceSample> list;
        for (std::size_t i = 0; i < samples.size(); ++i) list.push_back(samples[i]);
        std::sort(list.begin(), list.end(), less);
        return list;
    };
    for (const LatLong grid : {LatLong{64, 32}, LatLong{31, 17}, LatLong{3, 2}, LatLong{1, 1}}) {
        const Image image = noise(grid.width, grid.height, 6);
        for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
            const auto plain = sorted(texel_samples(image, domain));
            const auto shuffled = sorted(shuffled_texel_samples(image, domain, 5));
            ASSERT_EQ(plain.size(), shuffled.size());
            for (std::size_t i = 0; i < plain.size(); ++i) {
                EXPECT_EQ(plain[i].direction, shuffled[i].direction);
                EXPECT_EQ(plain[i].radiance, shuffled[i].radiance);
                EXPECT_EQ(plain[i].solid_angle, shuffled[i].solid_angle);
            }
        }
    }
}

TEST(TexelSamples, EveryBeginningOfAShuffleIsSpread) {
    // The mean direction of N independent texels, weighted by solid angle, differs from 0 by about 1 / sqrt(N).
    const Image image(128, 64);
    for (const std::uint32_t seed : {0u, 1u, 2u, 3u}) {
        const Samples samples = shuffled_texel_samples(image, Domain::sphere, seed);
        Vec3 sum;
        float total = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            sum = sum + samples[i].direction * samples[i].solid_angle;
            total += samples[i].solid_angle;
            const auto n = static_cast<float>(i + 1);
            if (i + 1 == 64 || i + 1 == 256 || i + 1 == 1024 || i + 1 == 3000) {
                EXPECT_LT(length(sum * (1 / total)), 0.6f / std::sqrt(n)) << n << " of seed " << seed;
            }
        }
    }
    const Samples a = shuffled_texel_samples(image, Domain::sphere, 1),
                  b = shuffled_texel_samples(image, Domain::sphere, 1),
                  c = shuffled_texel_samples(image, Domain::sphere, 2);
    EXPECT_TRUE(a[0].direction == b[0].direction && a[999].direction == b[999].direction);
    EXPECT_FALSE(a[0].direction == c[0].direction && a[1].direction == c[1].direction);
}

TEST(DirectedSamples, ShareTheDomainAndHoldTheNearestTexel) {
    const Image image = noise(64, 32, 6);
    for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
        const Directions directions = test::random_directions(domain, 1000, 3);
        const Samples samples = directed_samples(image, directions, domain);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            EXPECT_EQ(samples[i].direction, direction_at(directions, i));
            EXPECT_EQ(samples[i].radiance, seen(image, domain, samples[i].direction));
            EXPECT_FLOAT_EQ(samples[i].solid_angle, static_cast<float>(solid_angle(domain) / 1000));
        }
    }
}

TEST(MeanRadiance, IsEnergyOverFourPi) {
    const Image image = noise(64, 32, 7);
    EXPECT_NEAR(mean_radiance(image).g, energy(image)[1] / (4 * k_pi), 1e-6 * energy(image)[1]);
}

Rgb irradiance_in_double(const Samples& samples, Vec3 n) {
    double sum[3] = {};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto [d, L, omega] = samples[i];
        const double cosine =
            static_cast<double>(n.x) * d.x + static_cast<double>(n.y) * d.y + static_cast<double>(n.z) * d.z;
        const double weight = std::max(0.0, cosine) * omega;
        sum[0] += weight * L.r;
        sum[1] += weight * L.g;
        sum[2] += weight * L.b;
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

TEST(IrradianceSum, EqualsBruteForceInDoublePrecision) {
    for (const std::size_t count : {1, 15, 16, 17, 1000, 1024, 1025, 5000}) {
        Samples samples(count);
        const Samples even = test::samples_of(
            Domain::sphere, count,
            [](Vec3 d) {
                return Rgb{1 + d.x, std::exp(5 * d.y), d.z * d.z};
            },
            Sequence::random);
        for (std::size_t i = 0; i < count; ++i) {
            RadianceSample s = even[i];
            s.solid_angle *= 0.5f + 0.1f * static_cast<float>(i % 10);
            samples.set(i, s);
        }
        for (const std::size_t normal_count : {1, 3, 4, 5, 17}) {
            const Directions normals = test::random_directions(Domain::sphere, normal_count, 5);
            Colours out(normal_count);
            irradiance_sum(samples, normals, out);
            for (std::size_t j = 0; j < normal_count; ++j) {
                const Rgb expected = irradiance_in_double(samples, direction_at(normals, j));
                EXPECT_LE(test::norm(colour_at(out, j) - expected), 3e-6 * test::norm(expected) + 1e-6)
                    << count << " samples, normal " << j << " of " << normal_count;
            }
        }
    }
}

TEST(IrradianceSum, OfNothingOrBlackIsZero) {
    const Directions normals = test::random_directions(Domain::sphere, 20, 5);
    Colours out(20);
    std::fill_n(out.channel(0), 20, 5.0f);
    irradiance_sum(Samples(), normals, out);
    EXPECT_EQ(test::largest(out), 0);
    irradiance_sum(texel_samples(constant({32, 16}, {})), normals, out);
    EXPECT_EQ(test::largest(out), 0);
}

TEST(IrradianceSum, ConstantEnvironmentGivesPiTimesRadiance) {
    const Directions normals = test::random_directions(Domain::sphere, 200, 5);
    Colours out(200);
    irradiance_sum(texel_samples(constant({256, 128}, {1, 2, 0})), normals, out);
    for (std::size_t i = 0; i < 200; ++i) {
        // Texel centres represent texels, with an error of about (pi / 128)^2 / 12.
        EXPECT_NEAR(out.channel(0)[i], k_pi, 1e-4 * k_pi);
        EXPECT_NEAR(out.channel(1)[i], 2 * k_pi, 2e-4 * k_pi);
        EXPECT_EQ(out.channel(2)[i], 0);
    }
}

TEST(LatLongIrradiance, EqualsIrradianceSumAtAllNormals) {
    for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
        const Samples samples = texel_samples(test::small_sky(), domain);
        // With antipodes and without: odd sizes, and halves that do not fill whole lanes.
        for (const LatLong grid :
             {LatLong{64, 32}, LatLong{16, 8}, LatLong{31, 17}, LatLong{6, 2}, LatLong{10, 3}, LatLong{1, 1}}) {
            Colours expected(grid.size());
            irradiance_sum(samples, grid.directions(domain), expected);
            const Colours result = lat_long_irradiance(samples, grid, domain);
            EXPECT_LE(test::largest_difference(result, expected), 3e-6 * test::largest(expected))
                << grid.width << " x " << grid.height;
        }
    }
}

}  // namespace
}  // namespace lobelia
