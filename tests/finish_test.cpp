// The finishing steps, against plain oracles and noise-free truths.
#include "baker/finish/finish.h"

#include <oneapi/tbb/global_control.h>

#include <map>
#include <random>
#include <set>
#include <tuple>

#include "baker/atlas/split_edges.h"
#include "lobelia/codec.h"
#include "scenes.h"
#include "support.h"

namespace lobelia {
namespace {

using test::parallelogram;
using test::scene_of;
using test::with_uv;

template <class Run>
auto with_threads(std::size_t threads, const Run& run) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run();
}

// ---- Fits

TEST(FitPages, EveryTexelIsFittedAndNothingElseChanges) {
    const auto basis = make_basis("zh3").value();
    const std::size_t n = basis->fitted()->accumulated()->size();
    const PageLayout source{n}, target{basis->size()};
    Page page(7, 5, source.channels());
    std::mt19937 generator(3);
    for (auto& plane : page.planes)
        for (float& v : plane) v = static_cast<float>(generator() % 1000) / 500 - 0.5f;
    for (std::size_t i = 0; i < page.size(); ++i) page.chart[i] = static_cast<std::uint32_t>(generator() % 3);
    const std::vector<Page> pages{page};
    const auto fitted = fit_pages(pages, *basis->fitted());
    ASSERT_EQ(fitted.size(), 1u);
    EXPECT_EQ(fitted[0].chart, page.chart);
    EXPECT_EQ(fitted[0].planes[target.error()], page.planes[source.error()]);
    EXPECT_EQ(fitted[0].planes[target.irradiance(2)], page.planes[source.irradiance(2)]);
    for (std::size_t pixel = 0; pixel < page.size(); ++pixel) {
        std::vector<Rgb> accumulated(n), c(basis->size());
        for (std::size_t i = 0; i < n; ++i)
            accumulated[i] = {page.planes[3 * i][pixel], page.planes[3 * i + 1][pixel], page.planes[3 * i + 2][pixel]};
        basis->fitted()->fit(accumulated, c);
        for (std::size_t i = 0; i < c.size(); ++i) {
            ASSERT_EQ(fitted[0].planes[3 * i][pixel], c[i].r);
            ASSERT_EQ(fitted[0].planes[3 * i + 2][pixel], c[i].b);
        }
    }
}

// ---- Dilation

/// Charts 1 and 2 in random blots, some texels invalid, values that tell texels apart.
Page blots(std::size_t width, std::size_t height, std::uint32_t seed) {
    Page page(width, height, 2);
    std::mt19937 generator(seed);
    for (std::size_t i = 0; i < page.size(); ++i) {
        page.chart[i] = generator() % 8 == 0 ? 1 + generator() % 2 : 0;
        page.validity[i] = page.chart[i] == 0 || generator() % 4 == 0 ? 0.25f : 1.0f;
        for (auto& plane : page.planes) plane[i] = static_cast<float>(generator() % 1000);
    }
    return page;
}

/// By looking at all texels for each.
std::vector<float> dilated_plainly(const Page& page, std::size_t plane, const DilateOptions& options) {
    std::vector<float> result = page.planes[plane];
    const auto w = static_cast<long>(page.width), h = static_cast<long>(page.height);
    const auto usable = [&](std::size_t i) { return page.chart[i] != 0 && page.validity[i] >= options.least_validity; };
    const auto mean = [&](std::size_t i, bool own) -> std::optional<float> {
        long best = static_cast<long>(options.radius * options.radius) + 1;
        float sum = 0, count = 0;
        for (long j = 0; j < w * h; ++j) {
            const auto k = static_cast<std::size_t>(j);
            const long dx = j % w - static_cast<long>(i) % w, dy = j / w - static_cast<long>(i) / w;
            if (!usable(k) || (own && page.chart[k] != page.chart[i]) || dx * dx + dy * dy > best) continue;
            if (dx * dx + dy * dy < best) sum = count = 0;
            if (best > static_cast<long>(options.radius * options.radius) && dx * dx + dy * dy == best) continue;
            best = dx * dx + dy * dy;
            sum += page.planes[plane][k];
            count += 1;
        }
        return count > 0 ? std::optional(sum / count) : std::nullopt;
    };
    for (std::size_t i = 0; i < page.size(); ++i) {
        if (usable(i)) continue;
        std::optional<float> value = page.chart[i] != 0 ? mean(i, true) : std::nullopt;
        if (!value) value = mean(i, false);
        if (value) result[i] = *value;
    }
    return result;
}

TEST(Dilate, EqualsTheSearchOfAllTexels) {
    for (const std::size_t radius : {0, 1, 2, 5}) {
        const DilateOptions options{.radius = radius};
        std::vector<Page> pages{blots(33, 41, 1), blots(50, 7, 2)};
        const std::vector<Page> before = pages;
        dilate(pages, options);
        for (std::size_t p = 0; p < 2; ++p) {
            EXPECT_EQ(pages[p].chart, before[p].chart);
            EXPECT_EQ(pages[p].validity, before[p].validity);
            for (std::size_t c = 0; c < 2; ++c) {
                const std::vector<float> expected = dilated_plainly(before[p], c, options);
                for (std::size_t i = 0; i < expected.size(); ++i)
                    ASSERT_FLOAT_EQ(pages[p].planes[c][i], expected[i]) << radius << ' ' << p << ' ' << i;
            }
        }
    }
}

TEST(Dilate, TwiceIsOnce) {
    std::vector<Page> once{blots(40, 40, 3)};
    dilate(once);
    std::vector<Page> twice = once;
    dilate(twice);
    EXPECT_EQ(once[0].planes, twice[0].planes);
}

// ---- Denoising

/// A bake of four coefficients on one page, its guides, and what it would be without noise.
struct Noisy {
    PageLayout layout{4};
    std::vector<Page> pages;
    Page truth;
    Guides guides;
    std::vector<double> integrals{std::sqrt(4 * k_pi), 0, 0, 0};
};

/// E(x, y) over a flat chart of one square metre, with a light from a direction that turns slowly, seen by `samples`
/// samples in each texel; the noise of one sample is as large as what it measures.
template <class Irradiance>
Noisy noisy_bake(std::size_t side, const Irradiance& irradiance, double samples, std::uint32_t seed) {
    Noisy bake;
    bake.truth = Page(side, side, bake.layout.channels());
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
        // The measured error is itself off by a fifth.
        bake.pages[0].planes[bake.layout.error()][i] =
            static_cast<float>(std::abs(luminous * sigma * (1 + 0.2 * normal(generator))));
    }
    return bake;
}

void denoise(Noisy& bake, const DenoiseOptions& options = {}) {
    denoise(bake.pages, bake.layout, bake.guides, bake.integrals, 4 * k_pi, options);
}

double rms(const Page& a, const Page& b, std::size_t first, std::size_t last) {
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
    // Beside the edge hardly a texel is off by a fifth of the step.
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
    // Neighbours count as independent after each pass, though they have shared texels: a factor of two is forgiven.
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
    // Two charts meet in a staircase. What lies on one does not change a bit of the other, nor does what is invalid.
    Noisy bake = noisy_bake(64, smooth_light, 64, 9);
    Page& page = bake.pages[0];
    for (std::size_t i = 0; i < page.size(); ++i) {
        page.chart[i] = i % 64 > 20 + i / 64 / 3 ? 2 : 1;
        if (i % 97 == 0) page.validity[i] = 0.1f;
    }
    Noisy other = bake;
    std::mt19937 generator(3);
    for (std::size_t i = 0; i < page.size(); ++i)
        if (page.chart[i] == 2 || page.validity[i] < 0.5f)
            for (auto& plane : other.pages[0].planes) plane[i] = static_cast<float>(generator() % 1000);
    const Page untouched = other.pages[0];
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
        // Each is the mean of about 64 x 16 / 2 samples or more, whose spread is their size.
        EXPECT_NEAR(mean[0], 1.0, 4 * 1.0 / std::sqrt(512)) << gap;
        EXPECT_NEAR(mean[1], 1.2, 4 * 1.2 / std::sqrt(512)) << gap;
    }
}

TEST(Denoise, KeepsDirectionAndBrightnessApart) {
    // Brightness jumps, the light's direction does not: smoothed brightness must not bend it.
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
        with_threads(threads, [&] {
            denoise(bake);
            return 0;
        });
        return bake.pages[0].planes;
    };
    EXPECT_EQ(run(1), run(4));
}

// ---- Seams

/// Pages of an atlas that hold value(world position) at the texels of `map`, on all channels.
template <class Value>
std::vector<Page> pages_with(const Atlas& atlas, const TexelMap& map, const PageLayout& layout, const Value& value) {
    std::vector<Page> pages(atlas.pages(), Page(atlas.width(), atlas.height(), layout.channels()));
    const Guides guides = make_guides(atlas, map);
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        Page& page = pages[map.texels[i].page];
        const std::size_t place = map.texels[i].y * atlas.width() + map.texels[i].x;
        page.chart[place] = atlas.chart_of_triangle()[map.triangle[i]] + 1;
        page.validity[place] = 1;
        for (std::size_t c = 0; c < page.planes.size(); ++c)
            page.planes[c][place] =
                value(guides.position[map.texels[i].page][place], page.chart[place]) * static_cast<float>(c + 1);
    }
    return pages;
}

/// As a renderer reads it.
float bilinear(const Page& page, std::size_t channel, Vec2 p) {
    float sum = 0;
    const float x = p.x - 0.5f, y = p.y - 0.5f;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const float px = std::floor(x) + static_cast<float>(dx), py = std::floor(y) + static_cast<float>(dy);
            const auto cx = static_cast<std::size_t>(std::clamp(px, 0.0f, static_cast<float>(page.width - 1)));
            const auto cy = static_cast<std::size_t>(std::clamp(py, 0.0f, static_cast<float>(page.height - 1)));
            sum += page.planes[channel][cy * page.width + cx] * (1 - std::abs(x - px)) * (1 - std::abs(y - py));
        }
    return sum;
}

/// Two squares side by side in the world, with charts of different sizes and turns.
struct TwoSquares {
    enum class Where { one_object, two_objects, two_pages };
    World world;
    Atlas atlas;
    explicit TwoSquares(Where where) : world(make(where)), atlas(*Atlas::make(world, options(where))) {}

    static World make(Where where) {
        Mesh left = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.05f, 0.05f}, {0.45f, 0.45f});
        Mesh right = parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0});
        // A quarter turn: its left side lies at the top of its chart.
        right.lightmap_uv = {{0.55f, 0.5f}, {0.55f, 0.93f}, {0.88f, 0.93f}, {0.88f, 0.5f}};
        if (where != Where::one_object) return make_world(scene_of({left, right}));
        for (std::size_t v = 0; v < 4; ++v) {
            left.positions.push_back(right.positions[v]);
            left.normals.push_back(right.normals[v]);
            left.lightmap_uv.push_back(right.lightmap_uv[v]);
        }
        left.triangles.push_back({4, 5, 6});
        left.triangles.push_back({4, 6, 7});
        left.materials.assign(4, 0);
        return make_world(scene_of({left}));
    }
    static AtlasOptions options(Where where) {
        AtlasOptions result{.width = 64, .height = 48};
        if (where == Where::two_pages) result.texels_per_metre = 40;
        return result;
    }
    [[nodiscard]] double largest_difference(std::span<const Page> pages, std::size_t channel) const {
        const auto left = atlas.texel_triangle(0), right = atlas.texel_triangle(3);
        double largest = 0;
        for (float s = 0.01f; s < 1; s += 0.01f) {
            const Vec2 a = left[1] * (1 - s) + left[2] * s, b = right[0] * (1 - s) + right[2] * s;
            largest = std::max<double>(largest, std::abs(bilinear(pages[atlas.page_of(0)], channel, a) -
                                                         bilinear(pages[atlas.page_of(3)], channel, b)));
        }
        return largest;
    }
};

constexpr std::array k_two_squares = {TwoSquares::Where::one_object, TwoSquares::Where::two_objects,
                                      TwoSquares::Where::two_pages};

/// A smooth light, and a tenth more on one side.
float uneven_light(Vec3 p, std::uint32_t chart) { return (1 + p.y * p.y) * (chart == 1 ? 1.0f : 1.1f); }

TEST(Seams, Close) {
    const PageLayout layout{1};
    for (const auto where : k_two_squares) {
        const TwoSquares squares(where);
        const TexelMap map = map_texels(squares.atlas);
        ASSERT_EQ(squares.atlas.pages(), where == TwoSquares::Where::two_pages ? 2u : 1u);
        const auto before = pages_with(squares.atlas, map, layout, uneven_light);
        auto after = before;
        const SeamReport report = close_seams(after, layout, squares.atlas);
        EXPECT_EQ(report.edges, 1u);
        EXPECT_LT(report.after, 0.1 * report.before);
        for (std::size_t p = 0; p < after.size(); ++p)
            EXPECT_EQ(after[p].planes[layout.error()], before[p].planes[layout.error()]);

        // As renderers read it, with the gutter filled.
        auto dilated_before = before, dilated_after = after;
        dilate(dilated_before);
        dilate(dilated_after);
        for (std::size_t c = 0; c < layout.error(); ++c)
            EXPECT_LT(squares.largest_difference(dilated_after, c),
                      0.2 * squares.largest_difference(dilated_before, c));
    }
}

TEST(Seams, LeaveFarTexelsAlone) {
    const PageLayout layout{1};
    const TwoSquares squares(TwoSquares::Where::two_objects);
    const TexelMap map = map_texels(squares.atlas);
    const auto before = pages_with(squares.atlas, map, layout, uneven_light);
    auto after = before;
    close_seams(after, layout, squares.atlas);
    const Guides guides = make_guides(squares.atlas, map);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < before[0].size(); ++i) {
        const bool near = before[0].chart[i] != 0 && std::abs(guides.position[0][i].x - 1) < 2.5f / 20;
        changed += after[0].planes[0][i] != before[0].planes[0][i];
        if (!near) {
            EXPECT_EQ(after[0].planes[0][i], before[0].planes[0][i]);
        }
        // And nothing leaves the range of what was there.
        EXPECT_LE(after[0].planes[0][i], 2.3f);
        EXPECT_GE(after[0].planes[0][i], 0.0f);
    }
    EXPECT_GT(changed, 20u);
}

TEST(Seams, LeaveWhatAgrees) {
    const PageLayout layout{1};
    for (const auto where : k_two_squares) {
        const TwoSquares squares(where);
        const TexelMap map = map_texels(squares.atlas);
        const auto before = pages_with(squares.atlas, map, layout, [](Vec3, std::uint32_t) { return 0.7f; });
        auto after = before;
        const SeamReport report = close_seams(after, layout, squares.atlas);
        EXPECT_LT(report.before, 1e-6);
        for (std::size_t p = 0; p < after.size(); ++p)
            for (std::size_t i = 0; i < after[p].size(); ++i)
                ASSERT_NEAR(after[p].planes[0][i], before[p].planes[0][i], 1e-6f);
    }
}

TEST(Seams, WithinOneChartCloseToo) {
    // The wall of a tube is one chart whose left and right ends meet.
    constexpr std::uint32_t k_sides = 24;
    Mesh tube;
    for (std::uint32_t i = 0; i <= k_sides; ++i)
        for (const float z : {0.0f, 1.0f}) {
            const float s = static_cast<float>(i) / k_sides, a = static_cast<float>(2 * k_pi) * s;
            tube.positions.push_back({std::cos(a), std::sin(a), z});
            tube.normals.push_back({std::cos(a), std::sin(a), 0});
            tube.lightmap_uv.push_back({0.1f + 0.8f * s, 0.2f + 0.5f * z});
        }
    for (std::uint32_t i = 0; i < k_sides; ++i) {
        tube.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        tube.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    tube.materials.assign(tube.triangles.size(), 0);
    const World world = make_world(scene_of({tube}));
    const Atlas atlas = *Atlas::make(world, {.width = 100, .height = 40});
    const TexelMap map = map_texels(atlas);
    EXPECT_EQ(*std::max_element(atlas.chart_of_triangle().begin(), atlas.chart_of_triangle().end()), 0u);
    const PageLayout layout{1};
    // Brightness grows along the way around; in the end it is half as much again.
    auto pages = pages_with(atlas, map, layout, [](Vec3 p, std::uint32_t) {
        const float a = std::atan2(p.y, p.x);
        return 1 + (a < 0 ? a + static_cast<float>(2 * k_pi) : a) / 12;
    });
    const SeamReport report = close_seams(pages, layout, atlas);
    EXPECT_EQ(report.edges, 1u);
    EXPECT_LT(report.after, 0.1 * report.before);
}

/// A square beside two halves of one: no edge of the left matches one of the right from end to end.
TEST(Seams, CloseAtTJunctions) {
    const Mesh left = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.05f, 0.05f}, {0.45f, 0.45f});
    const Mesh lower = parallelogram({1, 0, 0}, {1, 0, 0}, {0, 0.5f, 0}, {0.55f, 0.05f}, {0.95f, 0.25f});
    const Mesh upper = parallelogram({1, 0.5f, 0}, {1, 0, 0}, {0, 0.5f, 0}, {0.55f, 0.35f}, {0.95f, 0.55f});
    const World world = make_world(scene_of({left, lower, upper}));
    const Atlas atlas = *Atlas::make(world, {.width = 64, .height = 64});
    const PageLayout layout{1};
    auto pages = pages_with(atlas, map_texels(atlas), layout, uneven_light);
    const SeamReport report = close_seams(pages, layout, atlas);
    EXPECT_EQ(report.edges, 3u);  // the halves of the long edge, and the edge between the two on the right
    EXPECT_LT(report.after, 0.1 * report.before);
}

TEST(Seams, StopAtCreasesAndUnbakedObjects) {
    const PageLayout layout{1};
    const Mesh floor = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0}, {0.4f, 0.4f});
    const Mesh wall = parallelogram({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.5f, 0.5f}, {0.9f, 0.9f});
    Mesh bare = parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0});
    bare.lightmap_uv.clear();
    const World world = make_world(scene_of({floor, wall, bare}));
    const Atlas atlas = *Atlas::make(world, {.width = 32, .height = 32});
    auto pages = pages_with(atlas, map_texels(atlas), layout, uneven_light);
    const auto before = pages;
    EXPECT_EQ(close_seams(pages, layout, atlas).edges, 0u);
    EXPECT_EQ(pages[0].planes, before[0].planes);
}

TEST(Seams, AreTheSameAtAnyNumberOfThreads) {
    const PageLayout layout{4};
    const TwoSquares squares(TwoSquares::Where::two_objects);
    const TexelMap map = map_texels(squares.atlas);
    const auto run = [&](std::size_t threads) {
        auto pages = pages_with(squares.atlas, map, layout, uneven_light);
        with_threads(threads, [&] { return close_seams(pages, layout, squares.atlas).edges; });
        return pages[0].planes;
    };
    EXPECT_EQ(run(1), run(4));
}

// ---- Edges

TEST(Edges, WeldEqualsTheSearchOfAllPairs) {
    // Clusters whose members lie within the tolerance of each other, and clusters apart.
    World world;
    std::mt19937 generator(4);
    const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
    constexpr float k_near = 1e-3f;
    std::vector<std::size_t> cluster;
    for (std::size_t c = 0; c < 60; ++c) {
        const Vec3 centre{std::floor(10 * uniform()), std::floor(10 * uniform()), static_cast<float>(c)};
        for (int i = 0; i < 5; ++i) {
            world.positions.push_back(centre + Vec3{uniform(), uniform(), uniform()} * (k_near / 2));
            cluster.push_back(c);
        }
    }
    const auto welded = weld_positions(world, k_near);
    for (std::size_t i = 0; i < cluster.size(); ++i)
        for (std::size_t j = 0; j < cluster.size(); ++j) EXPECT_EQ(welded[i] == welded[j], cluster[i] == cluster[j]);
}

TEST(Edges, SplitEqualsTheSearchOfAllPairs) {
    // Loose edges on a small lattice: many end within others.
    World world;
    std::mt19937 generator(9);
    std::vector<EdgePiece> pieces;
    const auto lattice = [&] { return static_cast<float>(generator() % 4); };
    for (std::uint32_t x = 0; x < 64; ++x)
        world.positions.push_back(
            {static_cast<float>(x % 4), static_cast<float>(x / 4 % 4), static_cast<float>(x / 16)});
    const auto vertex = [&] { return static_cast<std::uint32_t>(lattice() + 4 * lattice() + 16 * lattice()); };
    for (std::uint32_t t = 0; t < 150; ++t) {
        const std::uint32_t a = vertex(), b = vertex();
        if (a != b) pieces.push_back({std::min(a, b), std::max(a, b), t, 0, 0, 1});
    }
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> found, wanted;
    for (const EdgePiece& piece : split_edges(world, pieces, 1e-3f)) {
        EXPECT_LT(piece.low, piece.high);
        found.insert({piece.triangle, piece.low, piece.high});
    }
    for (const EdgePiece& piece : pieces) {
        const Vec3 a = world.positions[piece.low], d = world.positions[piece.high] - a;
        std::map<float, std::uint32_t> on{{0.0f, piece.low}, {1.0f, piece.high}};
        for (const EdgePiece& other : pieces)
            for (const std::uint32_t v : {other.low, other.high}) {
                const Vec3 p = world.positions[v] - a;
                const float s = dot(p, d) / dot(d, d);
                if (s > 0.01f && s < 0.99f && length(p - d * s) < 1e-3f) on[std::round(s * 1000) / 1000] = v;
            }
        for (auto at = on.begin(); std::next(at) != on.end(); ++at)
            wanted.insert({piece.triangle, std::min(at->second, std::next(at)->second),
                           std::max(at->second, std::next(at)->second)});
    }
    EXPECT_GT(found.size(), pieces.size() + 10);
    EXPECT_EQ(found, wanted);
}

}  // namespace
}  // namespace lobelia
