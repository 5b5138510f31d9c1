// Tests prefiltered cube maps against sums over all texels of the environment, and the split-sum table against rays.
#include "measure/prefilter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/ggx.h"
#include "lobelia/environment.h"
#include "lobelia/sky.h"
#include "support.h"

namespace lobelia {
namespace {

/// The integral as a sum over texels: D(h) (r.l) L(l) over that of D(h) (r.l).
Rgb summed(const Image& environment, Vec3 r, double roughness) {
    const LatLong grid = lat_long(environment);
    const double alpha2 = std::pow(roughness, 4);
    std::array<double, 3> sum{};
    double weights = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const auto cosine = static_cast<double>(dot(r, grid.direction(i)));
        if (cosine <= 0) continue;
        const double d = 1 / std::pow((1 + cosine) / 2 * (alpha2 - 1) + 1, 2);
        const double weight = d * cosine * grid.solid_angle(i / grid.width);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * static_cast<double>((&environment.pixels[i].r)[k]);
        weights += weight;
    }
    return {static_cast<float>(sum[0] / weights), static_cast<float>(sum[1] / weights),
            static_cast<float>(sum[2] / weights)};
}

TEST(Prefilter, TheReferenceIsTheSumOverTexels) {
    const Image environment = sky({256, 128});
    const auto directions = test::random_directions(Domain::sphere, 20, 2);
    for (const double roughness : {0.5, 0.7, 1.0})
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const Vec3 r = direction_at(directions, i);
            const Rgb wanted = summed(environment, r, roughness),
                      found = prefiltered_radiance(environment, r, roughness);
            EXPECT_NEAR(found.g, wanted.g, 0.01f * wanted.g + 1e-3f) << roughness;
        }
}

TEST(Prefilter, WhiteFurnace) {
    Image environment(16, 8);
    for (Rgb& pixel : environment.pixels) pixel = {1, 2, 0.5f};
    PrefilterOptions options;
    options.size = 16;
    options.levels = 5;
    options.samples = 64;
    for (const CubeConvention convention : {CubeConvention::gltf, CubeConvention::filament, CubeConvention::three}) {
        options.convention = convention;
        const auto levels = prefilter(environment, options);
        ASSERT_TRUE(levels) << levels.error().message;
        for (const CubeLevel& level : *levels) {
            EXPECT_LT(level.error, 1e-5);
            for (const Rgb& texel : level.texels) {
                EXPECT_NEAR(texel.r, 1, 1e-4f);
                EXPECT_NEAR(texel.g, 2, 2e-4f);
            }
        }
    }
}

TEST(Prefilter, ErrorsOfTheSkyAreSmall) {
    PrefilterOptions options;
    options.size = 64;
    options.levels = 5;
    options.samples = 512;
    const auto levels = prefilter(sky({256, 128}), options);
    ASSERT_TRUE(levels) << levels.error().message;
    std::printf("a sky with its sun\n");
    for (const CubeLevel& level : *levels) {
        std::printf("  %3zu texels, roughness %.2f: error %.4f\n", level.size, level.roughness, level.error);
        if (level.roughness > 0.4) {
            EXPECT_LT(level.error, 0.06);  // of bilinear filtering between few texels
        }
    }
}

TEST(Prefilter, LevelZeroIsTheEnvironment) {
    // Radiance that is linear in the direction.
    Image environment(256, 128);
    const LatLong grid = lat_long(environment);
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Vec3 w = grid.direction(i);
        environment.pixels[i] = {2 + w.x, 2 + w.y, 2 + w.z};
    }
    PrefilterOptions options;
    options.size = 32;
    options.levels = 2;
    options.samples = 64;
    for (const CubeConvention convention : {CubeConvention::gltf, CubeConvention::three}) {
        options.convention = convention;
        const auto levels = prefilter(environment, options);
        ASSERT_TRUE(levels) << levels.error().message;
        const CubeLevel& level = levels->front();
        for (std::size_t face = 0; face < 6; ++face)
            for (const auto& [x, y] : {std::pair<std::size_t, std::size_t>{0, 0}, {31, 5}, {16, 16}, {7, 30}}) {
                const auto place = [](std::size_t k) { return 2 * (static_cast<double>(k) + 0.5) / 32 - 1; };
                const Vec3 w = cube_direction(face, place(x), place(y));
                const Rgb texel = level.texels[(face * 32 + y) * 32 + x];
                EXPECT_NEAR(texel.r, convention == CubeConvention::three ? 2 - w.x : 2 + w.x, 0.02f) << face;
                EXPECT_NEAR(texel.g, 2 + w.y, 0.02f) << face;
                EXPECT_NEAR(texel.b, 2 + w.z, 0.02f) << face;
            }
    }
}

TEST(Prefilter, LevelsOfConventions) {
    EXPECT_EQ(roughness_of_level(CubeConvention::gltf, 0, 5), 0);
    EXPECT_EQ(roughness_of_level(CubeConvention::gltf, 4, 5), 1);
    EXPECT_EQ(roughness_of_level(CubeConvention::three, 1, 5), 0.25);
    for (std::size_t level = 0; level < 5; ++level) {
        const double r = roughness_of_level(CubeConvention::filament, level, 5);
        EXPECT_NEAR(r * (2 - r), static_cast<double>(level) / 4, 1e-12);
    }
}

TEST(Prefilter, BadSizesAreRefused) {
    const Image environment(8, 4);
    PrefilterOptions options;
    options.size = 48;
    EXPECT_FALSE(prefilter(environment, options));
    options.size = 16;
    options.levels = 6;
    const auto refused = prefilter(environment, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "the number of levels must be from 2 to 5 for this size");
    EXPECT_FALSE(prefilter(Image(), options));
}

TEST(SplitSum, IsTheAlbedoOfRays) {
    constexpr std::size_t k_size = 16;
    const auto table = split_sum_table(k_size);
    for (const std::size_t i : {17u, 100u, 250u}) {
        const float cosine = (static_cast<float>(i % k_size) + 0.5f) / k_size,
                    roughness = (static_cast<float>(i / k_size) + 0.5f) / k_size;
        const auto lobe = ggx::lobe_by_rays(ggx::make_view(cosine, roughness * roughness), 65536);
        EXPECT_NEAR(table[i][0] + table[i][1], lobe.albedo, 2e-3f);
        EXPECT_NEAR(table[i][1], lobe.fresnel, 2e-3f);
    }
}

}  // namespace
}  // namespace lobelia
