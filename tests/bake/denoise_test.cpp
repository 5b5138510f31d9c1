// Tests denoising against noise-free references.
#include "bake/finish/finish.h"

#include <random>

#include "scenes.h"
#include "support.h"
#include "threads.h"

namespace lobelia {
namespace {

using test::parallelogram;
using test::scene_of;
using test::with_uv;

/// A bake of four coefficients on one page, its guides, and its noise-free reference.
struct Noisy {
    PageChannels layout{4};
    std::vector<LightmapPage> pages;
    LightmapPage truth;
    Guides guides;
    std::vector<double> integrals{std::sqrt(4 * k_pi), 0, 0, 0};
};

/// E(x, y) over a flat chart of one square metre, with a light from a direction that turns slowly, seen by `samples`
/// samples in each texel; the noise of one sample is as large as what it measures.
template <class Irradiance>
Noisy noisy_bake(std::size_t side, const Irradiance& irradiance, double samples, std::uint32_t seed) {
    Noisy bake;
    bake.truth = LightmapPage(side, side, bake.layout.count());
    bake.guides.position.assign(1, std::vector<Vec3>(side * side));
    bake.guides.normal.assign(1, std::vector<Vec3>(side * side, Vec3{0, 0, 1}));
    std::fill(bake.truth.chart.begin(), bake.truth.chart.end(), 1u);
    std::fill(bake.truth.validity.begin(), bake.truth.validity.end(), 1.0f);
    bake.pages.push_back(bake.truth);
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < side * side; ++i) {
        const double x = (static_cast<double>(i % side) + 0.5) / static_cast<double>(side);
        const double y = (static_cast<double>(i / side) + 0.5) / static_cast<double>(side);
        bake.guides.position[0][i] = {static_cast<float>(x), static_cast<float>(y), 0};
        const double E = irradiance(x, y), sigma = samples > 0 ? E / std::sqrt(samples) : 0;
        const double common = normal(generator);
        const double ratios[4] = {1, 0.5 * std::cos(x), 0.5 * std::sin(x), 0.3};
        for (std::size_t k = 0; k < 3; ++k) {
            const double tint = 1 - 0.2 * static_cast<double>(k);
            bake.truth.planes[bake.layout.irradiance(k)][i] = static_cast<float>(tint * E);
            bake.pages[0].planes[bake.layout.irradiance(k)][i] = static_cast<float>(tint * (E + sigma * common));
            for (std::size_t c = 0; c < 4; ++c) {
                const double own = normal(generator);
                bake.truth.planes[bake.layout.coefficient(c, k)][i] = static_cast<float>(tint * E * ratios[c]);
                bake.pages[0].planes[bake.layout.coefficient(c, k)][i] =
                    static_cast<float>(tint * (E * ratios[c] + sigma * (0.8 * common * ratios[c] + 0.6 * own)));
            }
        }
        const double luminous = 0.2126 + 0.8 * 0.7152 + 0.6 * 0.0722;
        // The measured error has an uncertainty of a fifth.
        bake.pages[0].planes[bake.layout.error()][i] =
            static_cast<float>(std::abs(luminous * sigma * (1 + 0.2 * normal(generator))));
    }
    return bake;
}

void denoise(Noisy& bake, const DenoiseOptions& options = {}) {
    denoise(bake.pages, bake.layout, bake.guides, bake.integrals, 4 * k_pi, options);
}

double rms(const LightmapPage& a, const LightmapPage& b, std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t c = first; c < last; ++c)
        for (std::size_t i = 0; i < a.size(); ++i)
            sum += std::pow(static_cast<double>(a.planes[c][i]) - b.planes[c][i], 2);
    return std::sqrt(sum / static_cast<double>(a.size() * (last - first)));
}

double smooth_light(double x, double y) { return 2 + std::sin(3 * x + 1) * std::cos(2 * y); }
double shadow(double x, double y) { return x + 0.3 * y < 0.62 ? 2.0 : 0.2; }

TEST(Denoise, BringsNoiseCloserToItsTruth) {
    for (const double samples : {16.0, 64.0, 256.0}) {
        Noisy bake = noisy_bake(96, smooth_light, samples, 5);
        const double coefficients = rms(bake.pages[0], bake.truth, 0, 12), E = rms(bake.pages[0], bake.truth, 12, 15);
        denoise(bake);
        EXPECT_LT(rms(bake.pages[0], bake.truth, 0, 12), 0.25 * coefficients) << samples;
        EXPECT_LT(rms(bake.pages[0], bake.truth, 12, 15), 0.3 * E) << samples;
    }
}

TEST(Denoise, KeepsTheEdgesOfShadows) {
    // The step is seven standard errors of a texel in the light.
    Noisy bake = noisy_bake(96, shadow, 64, 6);
    const double before = rms(bake.pages[0], bake.truth, 0, 12);
    denoise(bake);
    EXPECT_LT(rms(bake.pages[0], bake.truth, 0, 12), 0.2 * before);
    // Near the edge, hardly any texel has an error of a fifth of the step.
    std::size_t off = 0;
    for (std::size_t i = 0; i < bake.truth.size(); ++i)
        off += std::abs(bake.pages[0].planes[12][i] - bake.truth.planes[12][i]) > 0.2f * 1.8f;
    EXPECT_LT(off, 8u);
}

TEST(Denoise, TellsTheErrorThatIsLeft) {
    const auto flat = [](double, double) { return 3.0; };
    Noisy bake = noisy_bake(96, flat, 64, 8);
    denoise(bake);
    double squared = 0;
    for (const float e : bake.pages[0].planes[bake.layout.error()]) squared += static_cast<double>(e) * e;
    const double told = std::sqrt(squared / static_cast<double>(bake.truth.size()));
    const double is = rms(bake.pages[0], bake.truth, 12, 13) * (0.2126 + 0.8 * 0.7152 + 0.6 * 0.0722);
    // After each pass the filter treats neighbours as independent, although they share texels: allow a factor of two.
    EXPECT_GT(told, 0.5 * is);
    EXPECT_LT(told, 2 * is);
}

TEST(Denoise, LeavesWhatHasNoNoise) {
    for (const auto& light : {smooth_light, shadow}) {
        Noisy bake = noisy_bake(64, light, 0, 7);
        denoise(bake);
        for (std::size_t c = 0; c < 15; ++c)
            for (std::size_t i = 0; i < bake.truth.size(); ++i)
                ASSERT_FLOAT_EQ(bake.pages[0].planes[c][i], bake.truth.planes[c][i]);
    }
}

TEST(Denoise, NeverReadsAnotherChart) {
    // Two charts meet in a staircase. Texels of one chart and invalid texels must not change a bit of the other chart.
    Noisy bake = noisy_bake(64, smooth_light, 64, 9);
    LightmapPage& page = bake.pages[0];
    for (std::size_t i = 0; i < page.size(); ++i) {
        page.chart[i] = i % 64 > 20 + i / 64 / 3 ? 2 : 1;
        if (i % 97 == 0) page.validity[i] = 0.1f;
    }
    Noisy other = bake;
    std::mt19937 generator(3);
    for (std::size_t i = 0; i < page.size(); ++i)
        if (page.chart[i] == 2 || page.validity[i] < 0.5f)
            for (auto& plane : other.pages[0].planes) plane[i] = static_cast<float>(generator() % 1000);
    const LightmapPage untouched = other.pages[0];
    denoise(bake);
    denoise(other);
    for (std::size_t c = 0; c < page.planes.size(); ++c)
        for (std::size_t i = 0; i < page.size(); ++i) {
            if (page.validity[i] < 0.5f) {
                ASSERT_EQ(other.pages[0].planes[c][i], untouched.planes[c][i]);
            } else if (page.chart[i] == 1) {
                ASSERT_EQ(page.planes[c][i], other.pages[0].planes[c][i]);
            }
        }
}

TEST(Denoise, StopsAtCreasesAndGaps) {
    // Light changes where the surface bends by a right angle, and where its two parts are a metre apart.
    for (const bool gap : {false, true}) {
        const auto step = [](double x, double) { return x < 0.5 ? 1.0 : 1.2; };
        Noisy bake = noisy_bake(64, step, 16, 10);
        for (std::size_t i = 0; i < bake.truth.size(); ++i)
            if (i % 64 >= 32) {
                Vec3& p = bake.guides.position[0][i];
                if (gap) p.x += 1;
                if (!gap) {
                    p = {0.5f, p.y, p.x - 0.5f};
                    bake.guides.normal[0][i] = {-1, 0, 0};
                }
            }
        denoise(bake);
        double mean[2] = {0, 0};
        for (std::size_t y = 0; y < 64; ++y)
            for (std::size_t s = 0; s < 2; ++s) mean[s] += bake.pages[0].planes[12][y * 64 + 31 + s] / 64;
        // Each value is the mean of at least about 64 x 16 / 2 samples, whose standard deviation equals their mean.
        EXPECT_NEAR(mean[0], 1.0, 4 * 1.0 / std::sqrt(512)) << gap;
        EXPECT_NEAR(mean[1], 1.2, 4 * 1.2 / std::sqrt(512)) << gap;
    }
}

TEST(Denoise, KeepsDirectionAndBrightnessApart) {
    // Brightness changes abruptly, the light's direction does not: filtering must not change the direction.
    Noisy bake = noisy_bake(96, shadow, 64, 11);
    denoise(bake);
    for (std::size_t i = 0; i < bake.truth.size(); ++i) {
        const double expected = bake.truth.planes[3][i] / bake.truth.planes[0][i];
        EXPECT_NEAR(bake.pages[0].planes[3][i] / bake.pages[0].planes[0][i], expected, 0.12);
    }
}

TEST(Denoise, IsTheSameAtAnyNumberOfThreads) {
    const auto run = [](std::size_t threads) {
        Noisy bake = noisy_bake(64, smooth_light, 64, 12);
        test::with_threads(threads, [&] {
            denoise(bake);
            return 0;
        });
        return bake.pages[0].planes;
    };
    EXPECT_EQ(run(1), run(4));
}

}  // namespace
}  // namespace lobelia
