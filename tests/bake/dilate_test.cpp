// Tests dilation and the fitting of pages against plain oracles.
#include "bake/finish/finish.h"

#include <random>

#include "lobelia/codec.h"
#include "support.h"

namespace lobelia {
namespace {

TEST(FitPages, EveryTexelIsFittedAndNothingElseChanges) {
    const auto basis = make_basis("zh3").value();
    const std::size_t n = basis->fitted()->accumulated()->size();
    const PageChannels source{n}, target{basis->size()};
    LightmapPage page(7, 5, source.count());
    std::mt19937 generator(3);
    for (auto& plane : page.planes)
        for (float& v : plane) v = static_cast<float>(generator() % 1000) / 500 - 0.5f;
    for (std::size_t i = 0; i < page.size(); ++i) page.chart[i] = static_cast<std::uint32_t>(generator() % 3);
    const std::vector<LightmapPage> pages{page};
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

/// Random patches of charts 1 and 2, some texels invalid, with a different value in each texel.
LightmapPage blots(std::size_t width, std::size_t height, std::uint32_t seed) {
    LightmapPage page(width, height, 2);
    std::mt19937 generator(seed);
    for (std::size_t i = 0; i < page.size(); ++i) {
        page.chart[i] = generator() % 8 == 0 ? 1 + generator() % 2 : 0;
        page.validity[i] = page.chart[i] == 0 || generator() % 4 == 0 ? 0.25f : 1.0f;
        for (auto& plane : page.planes) plane[i] = static_cast<float>(generator() % 1000);
    }
    return page;
}

/// Searches all texels for each one.
std::vector<float> dilated_plainly(const LightmapPage& page, std::size_t plane, const DilateOptions& options) {
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
        std::vector<LightmapPage> pages{blots(33, 41, 1), blots(50, 7, 2)};
        const std::vector<LightmapPage> before = pages;
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
    std::vector<LightmapPage> once{blots(40, 40, 3)};
    dilate(once);
    std::vector<LightmapPage> twice = once;
    dilate(twice);
    EXPECT_EQ(once[0].planes, twice[0].planes);
}

}  // namespace
}  // namespace lobelia
