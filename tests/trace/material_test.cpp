// Tests reflection: samples agree with pdfs and values, no energy is created, textures are looked up at the right
// place.
#include "trace/material.h"

#include <gtest/gtest.h>

#include "core/math/colour.h"
#include "core/sample/directions.h"
#include "small_scenes.h"
#include "support.h"
#include "trace/texture.h"

namespace lobelia {
namespace {

/// Materials from matt to nearly specular.
std::vector<Reflectance> reflectances() {
    std::vector<Reflectance> result{make_reflectance(test::matte({0.2f, 0.5f, 0.8f}), {0.2f, 0.5f, 0.8f}, 0, 1)};
    Material m;
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f})
        for (const float metallic : {0.0f, 0.5f, 1.0f})
            result.push_back(make_reflectance(m, {0.9f, 0.6f, 0.1f}, metallic, roughness));
    m.ior = 2;
    m.specular = 0.5f;
    m.specular_color = {1, 0.2f, 0.5f};
    result.push_back(make_reflectance(m, {0.5f, 0.5f, 0.5f}, 0.2f, 0.4f));
    return result;
}

const std::array k_views = {Vec3{0, 0, 1}, normalize(Vec3{0.5f, 0.2f, 0.7f}), normalize(Vec3{-1, 0.3f, 0.15f})};

Pair point_of(std::uint32_t i) { return pair(1, i, 0, 1); }
float choice_of(std::uint32_t i) { return pair(1, i, 1, 1).a; }

TEST(Reflection, SampleAgreesWithPdfAndValue) {
    for (const Reflectance& s : reflectances())
        for (const Vec3 wo : k_views)
            for (std::uint32_t i = 0; i < 256; ++i) {
                const Scattered sample = scatter(s, wo, point_of(i), choice_of(i));
                if (sample.pdf == 0) continue;
                EXPECT_GT(sample.wi.z, 0);
                EXPECT_NEAR(length(sample.wi), 1, 1e-5);
                const float pdf = reflect(s, wo, sample.wi).pdf;
                EXPECT_NEAR(sample.pdf, pdf, 1e-4 * pdf);
                const Rgb value = reflect(s, wo, sample.wi).value;
                EXPECT_NEAR(sample.weight.r * pdf, value.r, 1e-4 * value.r);
                EXPECT_NEAR(sample.weight.b * pdf, value.b, 1e-4 * value.b);
            }
}

TEST(Reflection, SamplesFollowPdf) {
    // Chi-square over cells of height and azimuth; the density is averaged over each cell on a grid of 32 x 32.
    constexpr std::size_t rows = 8, columns = 8, fine = 32;
    constexpr std::uint32_t count = 40000;
    for (const Reflectance& s : reflectances())
        for (const Vec3 wo : k_views) {
            std::vector<double> expected(rows * columns + 1), hits(expected.size());
            for (std::size_t y = 0; y < rows * fine; ++y)
                for (std::size_t x = 0; x < columns * fine; ++x) {
                    const float z = (static_cast<float>(y) + 0.5f) / (rows * fine),
                                turn = (static_cast<float>(x) + 0.5f) / (columns * fine);
                    const double share = 2 * k_pi / (rows * columns * fine * fine);
                    expected[y / fine * columns + x / fine] +=
                        count * share * static_cast<double>(reflect(s, wo, around_z(z, turn)).pdf);
                }
            // The remaining directions lie below the horizon.
            expected.back() = count;
            for (std::size_t i = 0; i + 1 < expected.size(); ++i) expected.back() -= expected[i];

            std::mt19937 generator(5);
            const auto random = [&] { return unit_float(static_cast<std::uint32_t>(generator())); };
            for (std::uint32_t i = 0; i < count; ++i) {
                const Pair point{random(), random()};
                const Scattered sample = scatter(s, wo, point, random());
                if (sample.pdf == 0) {
                    ++hits.back();
                    continue;
                }
                double turn =
                    std::atan2(static_cast<double>(sample.wi.y), static_cast<double>(sample.wi.x)) / (2 * k_pi);
                if (turn < 0) turn += 1;
                ++hits[std::min(static_cast<std::size_t>(sample.wi.z * rows), rows - 1) * columns +
                       std::min(static_cast<std::size_t>(turn * columns), columns - 1)];
            }

            // Merge cells with too few samples.
            double chi_square = 0, few_expected = 0, few_hits = 0;
            std::size_t cells = 0;
            const auto judge = [&](double h, double e) {
                chi_square += (h - e) * (h - e) / e;
                ++cells;
            };
            for (std::size_t i = 0; i < expected.size(); ++i) {
                if (expected[i] >= 20) {
                    judge(hits[i], expected[i]);
                } else {
                    few_expected += expected[i], few_hits += hits[i];
                }
            }
            if (few_expected >= 20) judge(few_hits, few_expected);
            // The grid cannot follow the narrowest lobes.
            if (s.has_layer && s.width < 0.1f) continue;
            EXPECT_LT(chi_square, test::chi_square_limit(cells - 1)) << s.width << " wo.z " << wo.z;
        }
}

TEST(Reflection, DensityIntegratesToAtMostOne) {
    for (const Reflectance& s : reflectances())
        for (const Vec3 wo : k_views) {
            // Importance sampling: the mean of 1 over the sampled share is the integral of the pdf.
            double landed = 0;
            for (std::uint32_t i = 0; i < 4096; ++i)
                landed += scatter(s, wo, point_of(i), choice_of(i)).pdf > 0 ? 1 : 0;
            EXPECT_LE(landed / 4096, 1);
            EXPECT_GT(landed / 4096, 0.3);
        }
}

TEST(Reflection, LosesLightInADiffuseField) {
    // For a single view glTF's model may reflect more than it receives; the cosine-weighted mean over all views does
    // not.
    for (const Reflectance& s : reflectances()) {
        test::Estimate albedo;
        for (std::uint32_t i = 0; i < 16384; ++i)
            albedo.add(static_cast<double>(
                largest(scatter(s, cosine_direction(pair(1, i, 2, 1)), point_of(i), choice_of(i)).weight)));
        EXPECT_LT(albedo.mean(), 1) << s.width;
        EXPECT_GT(albedo.mean(), 0.05);
    }
}

TEST(Reflection, IsReciprocal) {
    for (const Reflectance& s : reflectances())
        for (std::uint32_t i = 0; i < 64; ++i) {
            const Vec3 a = cosine_direction(point_of(2 * i)), b = cosine_direction(point_of(2 * i + 1));
            const float there = reflect(s, a, b).value.r / b.z, back = reflect(s, b, a).value.r / a.z;
            EXPECT_NEAR(there, back, 2e-4 * there);
        }
}

TEST(Reflection, DiffuseIsLambert) {
    const Reflectance s = make_reflectance(test::matte({0.5f, 0.25f, 1}), {0.5f, 0.25f, 1}, 0, 0.3f);
    EXPECT_FALSE(s.has_layer);
    const Vec3 wi = normalize(Vec3{1, 1, 2});
    EXPECT_NEAR(reflect(s, {0, 0, 1}, wi).value.g, 0.25 * wi.z / k_pi, 1e-7);
}

TEST(Reflection, FresnelAtNormalIncidenceFollowsTheIndex) {
    Material m;
    m.ior = 2;  // ((2 - 1) / (2 + 1))^2
    EXPECT_NEAR(make_reflectance(m, {0.5f, 0.5f, 0.5f}, 0, 0.5f).layer_0.g, 1.0 / 9, 1e-7);
    EXPECT_NEAR(make_reflectance(m, {0.5f, 0.5f, 0.5f}, 1, 0.5f).layer_0.g, 0.5, 1e-7);
}

Texture two_by_two(Texture::Wrap wrap) {
    Texture t;
    t.width = t.height = 2;
    t.texels = {{255, 0, 0, 0}, {0, 255, 0, 85}, {0, 0, 255, 170}, {128, 128, 128, 255}};
    t.wrap_u = t.wrap_v = wrap;
    return t;
}

TEST(Textures, TexelCentresGiveTexels) {
    const Texture t = two_by_two(Texture::Wrap::repeat);
    EXPECT_EQ(texture_value(t, {0.25f, 0.25f}, Curve::srgb)[0], 1);
    EXPECT_EQ(texture_value(t, {0.75f, 0.25f}, Curve::srgb)[1], 1);
    EXPECT_NEAR(texture_value(t, {0.25f, 0.75f}, Curve::linear)[3], 170.0 / 255, 1e-6);
    EXPECT_NEAR(texture_value(t, {0.75f, 0.75f}, Curve::srgb)[0], linear_from_srgb(128.0 / 255), 1e-6);
    EXPECT_NEAR(texture_value(t, {0.75f, 0.75f}, Curve::linear)[0], 128.0 / 255, 1e-6);
}

TEST(Textures, WrapAsTheySay) {
    const Texture repeat = two_by_two(Texture::Wrap::repeat), mirror = two_by_two(Texture::Wrap::mirror),
                  clamp = two_by_two(Texture::Wrap::clamp);
    const auto red = [](const Texture& t, float u) { return texture_value(t, {u, 0.25f}, Curve::linear)[0]; };
    EXPECT_EQ(red(repeat, 1.25f), 1);
    EXPECT_EQ(red(repeat, -0.75f), 1);
    EXPECT_EQ(red(repeat, 0), 0.5f);
    EXPECT_EQ(red(mirror, 1.25f), 0);
    EXPECT_EQ(red(mirror, 1.75f), 1);
    EXPECT_EQ(red(mirror, 0), 1);
    EXPECT_EQ(red(clamp, -5), 1);
    EXPECT_EQ(red(clamp, 5), 0);
}

TEST(Textures, NearestGivesTheTexelAround) {
    Texture t = two_by_two(Texture::Wrap::repeat);
    t.filter = Texture::Filter::nearest;
    const auto red = [&](float u) { return texture_value(t, {u, 0.01f}, Curve::srgb)[0]; };
    for (const float u : {0.0f, 0.01f, 0.25f, 0.49f, 1.1f, -0.9f}) EXPECT_EQ(red(u), 1) << u;
    for (const float u : {0.5f, 0.51f, 0.99f, -0.01f, 1.6f}) EXPECT_EQ(red(u), 0) << u;
}

TEST(Textures, AnyCoordinateIsSafe) {
    for (const auto wrap : {Texture::Wrap::repeat, Texture::Wrap::mirror, Texture::Wrap::clamp})
        for (const float u : {1e30f, -1e30f, INFINITY, NAN, 1e-30f, 16777216.0f})
            for (const float v : texture_value(two_by_two(wrap), {u, u}, Curve::srgb)) EXPECT_TRUE(v >= 0 && v <= 1);
}

TEST(Textures, TransformMovesCoordinates) {
    TextureUse use;
    use.uv_from_mesh = {{{0, -2, 0.5f}, {3, 0, 1}}};
    EXPECT_EQ(texture_uv(use, {1, 2}), (Vec2{-3.5f, 4}));
}

TEST(Directions, CosSinTurnsIsExactEnough) {
    for (int i = 0; i <= 100000; ++i) {
        const float t = static_cast<float>(i) / 100000;
        const auto [c, s] = cos_sin_turns(t);
        ASSERT_NEAR(c, std::cos(2 * k_pi * static_cast<double>(t)), 3e-7);
        ASSERT_NEAR(s, std::sin(2 * k_pi * static_cast<double>(t)), 3e-7);
    }
}

TEST(Directions, AnglesAreExactEnough) {
    for (int i = -100000; i <= 100000; ++i) {
        const double turn = i / 200000.0;
        const auto s = static_cast<float>(std::sin(2 * k_pi * turn)), c = static_cast<float>(std::cos(2 * k_pi * turn));
        ASSERT_NEAR(turns_of(s, c), std::atan2(static_cast<double>(s), static_cast<double>(c)) / (2 * k_pi), 1e-7);
        ASSERT_NEAR(rough_half_turns_of(c), std::acos(static_cast<double>(c)) / k_pi, 2.2e-5);
    }
    EXPECT_EQ(turns_of(0, 0), 0);
}

}  // namespace
}  // namespace lobelia
