// Tests mip levels of pages against plain means, and that no light runs from chart to chart.
#include "bake/write/page_levels.h"

#include <map>
#include <random>

#include "bake/preflight/preflight.h"
#include "support.h"

namespace lobelia {
namespace {

/// Charts of 3 x 3 texels and fewer, some texels invalid, with a different value in each texel.
LightmapPage patches(std::size_t width, std::size_t height, std::uint32_t seed) {
    LightmapPage page(width, height, 2);
    std::mt19937 generator(seed);
    for (std::size_t i = 0; i < page.size(); ++i) {
        page.chart[i] = static_cast<std::uint32_t>((i / width / 3 + i % width / 3) % 4);
        page.validity[i] = page.chart[i] == 0 || generator() % 4 == 0 ? 0.25f : 1.0f;
        for (auto& plane : page.planes) plane[i] = static_cast<float>(generator() % 1000);
    }
    return page;
}

TEST(MipLevels, TexelsAreMeansOfTheValidTexelsOfOneChart) {
    const LightmapPage page = patches(36, 20, 1);
    const LightmapPage level = mip_levels(page, 1).front();
    ASSERT_EQ(level.width, 18u);
    ASSERT_EQ(level.height, 10u);
    std::size_t mixed = 0;
    for (std::size_t y = 0; y < level.height; ++y)
        for (std::size_t x = 0; x < level.width; ++x) {
            std::map<std::uint32_t, std::vector<std::size_t>> of_chart;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::size_t i = (2 * y + k / 2) * page.width + 2 * x + k % 2;
                if (page.chart[i] != 0 && page.validity[i] >= 0.5f) of_chart[page.chart[i]].push_back(i);
            }
            const std::size_t at = y * level.width + x;
            if (of_chart.empty()) {
                EXPECT_EQ(level.chart[at], 0u);
                EXPECT_EQ(level.validity[at], 0.0f);
                continue;
            }
            mixed += of_chart.size() > 1;
            std::size_t most = 0;
            for (const auto& [chart, texels] : of_chart) most = std::max(most, texels.size());
            const auto& texels = of_chart.at(level.chart[at]);
            EXPECT_EQ(texels.size(), most);
            for (std::size_t plane = 0; plane < 2; ++plane) {
                float sum = 0;
                for (const std::size_t i : texels) sum += page.planes[plane][i];
                EXPECT_NEAR(level.planes[plane][at], sum / static_cast<float>(texels.size()), 1e-3f);
            }
        }
    EXPECT_GT(mixed, 10u);
}

/// The value at a place of a level [its texels], filtered as hardware does, clamped at the borders.
float filtered(const LightmapPage& page, double x, double y) {
    const auto texel = [&](double i, double j) {
        const auto at = [](double v, std::size_t size) {
            return static_cast<std::size_t>(std::clamp(v, 0.0, static_cast<double>(size) - 1));
        };
        return static_cast<double>(page.planes[0][at(j, page.height) * page.width + at(i, page.width)]);
    };
    const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5), fx = x - 0.5 - x0, fy = y - 0.5 - y0;
    const double top = (1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0);
    const double bottom = (1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1);
    return static_cast<float>((1 - fy) * top + fy * bottom);
}

TEST(MipLevels, NoLightRunsBetweenChartsThatArePadded) {
    // A dark chart between bright ones, as near to it as the levels permit, at every alignment.
    constexpr std::size_t k_side = 64, k_dark = 17;
    for (std::uint32_t levels = 1; levels <= 4; ++levels)
        for (std::size_t begin = 8; begin < 24; ++begin) {
            const std::size_t gap = padding_for_levels(levels);
            LightmapPage page(k_side, k_side, 1);
            for (std::size_t i = 0; i < page.size(); ++i) {
                const std::size_t x = i % k_side;
                const bool dark = x >= begin && x < begin + k_dark;
                const bool bright = x + gap < begin || x >= begin + k_dark + gap;
                page.chart[i] = dark ? 1 : bright ? 2 : 0;
                page.validity[i] = page.chart[i] != 0;
                page.planes[0][i] = bright ? 1000.0f : 1.0f;
            }
            std::vector<LightmapPage> all = mip_levels(page, levels - 1);
            all.insert(all.begin(), page);
            for (std::size_t level = 0; level < all.size(); ++level) {
                const double scale = std::exp2(-static_cast<double>(level));
                for (double x = static_cast<double>(begin); x <= static_cast<double>(begin + k_dark); x += 0.25)
                    ASSERT_EQ(filtered(all[level], x * scale, 20 * scale), 1.0f)
                        << levels << " " << begin << " " << level;
            }
        }
}

TEST(MipLevels, AConstantStaysAConstant) {
    LightmapPage page = patches(64, 32, 2);
    for (float& v : page.planes[0]) v = 0.7f;
    for (const LightmapPage& level : mip_levels(page, 5))
        for (const float v : level.planes[0]) EXPECT_NEAR(v, 0.7f, 1e-6f);
}

}  // namespace
}  // namespace lobelia
