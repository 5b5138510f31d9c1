// Tests the report of a bake: it loads nothing, no string escapes, pictures hold the pages' values, figures are right.
#include "report/bake_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/preflight/preflight.h"
#include "page_support.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

using namespace test;

/// Two pages of one small codec, some texels of them baked: E and coefficients are simple functions of the place.
struct SmallBake {
    Codec codec = *make_codec("sh1/moments/convolution");
    std::vector<LightmapPage> pages;
    std::vector<AtlasPlacement> placements{{}, {}};
    BakeReport page;

    explicit SmallBake(std::size_t width = 6, std::size_t height = 4) {
        const PageChannels layout{codec.basis().size()};
        for (std::uint32_t p = 0; p < 2; ++p) {
            LightmapPage& made = pages.emplace_back(width, height, layout.count());
            for (std::size_t i = 0; i < made.size(); ++i) {
                if (i % 3 == 2) continue;
                made.chart[i] = 2 * p + static_cast<std::uint32_t>(i % 3) + 1;
                made.validity[i] = i % 2 == 0 ? 1.0f : 0.25f;
                for (std::size_t plane = 0; plane < layout.count(); ++plane)
                    made.planes[plane][i] = static_cast<float>(plane + 1) * (i % 2 == 0 ? 1.0f : -2.0f);
            }
        }
        page.title = "small";
        page.light = {pages, placements, layout, codec, Frame::world};
        for (const LightmapPage& p : pages) page.codec_irradiance.emplace_back(p.size(), Rgb{14, 14, 14});
        page.object_of_chart = {0, 1, 1, 1};
        Scene scene;
        scene.objects = {{"table", 0, {}}, {"floor", 0, {}}, {"no lightmap", 0, {}}};
        page.objects = object_figures(scene, page.light, page.object_of_chart, page.codec_irradiance);
        page.statistics = BakeStatistics{};
    }
};

nlohmann::json data_of(const std::string& html) { return nlohmann::json::parse(script_element(html, "bake-data")); }
nlohmann::json pictures_of(const std::string& html) {
    return nlohmann::json::parse(script_element(html, "picture-data"));
}

/// The 16-bit values of a stored picture.
std::vector<std::uint16_t> words_of(const nlohmann::json& picture, const char* key) {
    std::string text = picture[key];
    const auto bytes = bytes_of_base64(text.substr(0, text.find('=')));
    std::vector<std::uint16_t> words;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
        words.push_back(static_cast<std::uint16_t>(bytes[i] | bytes[i + 1] << 8));
    return words;
}

TEST(BakeReport, LoadsNothing) { expect_loads_nothing(bake_html(SmallBake().page)); }
TEST(BakeReport, FillsEveryMark) { expect_filled(bake_html(SmallBake().page)); }
TEST(BakeReport, IsThereWithoutAnything) {
    const std::string html = bake_html({});
    expect_filled(html);
    EXPECT_TRUE(data_of(html)["layers"].empty());
    EXPECT_TRUE(pictures_of(html).empty());
}

TEST(BakeReport, NoNameEndsItsScriptElement) {
    const std::string text = "</script><script>alert(1)</script><!-- \"quoted\" \\ {{bake}} {{page.css}}";
    SmallBake bake;
    bake.page.title = text;
    bake.page.warnings = {text};
    bake.page.settings = {{text, text}};
    bake.page.objects[0].name = text;
    bake.page.views = {{text, Image(2, 1), Image(2, 1), 4}};
    bake.page.checks = {{PreflightCheck::Level::bad, text, text}};
    bake.page.preflight_pictures = {{text, Image(1, 1)}};
    const std::string html = bake_html(bake.page);
    EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
    const auto data = data_of(html);
    EXPECT_EQ(data["title"], text);
    EXPECT_EQ(data["objects"][0]["name"], text);
    EXPECT_EQ(data["views"][0]["camera"], text);
    EXPECT_EQ(data["preflight"]["checks"][0]["text"], text);
    EXPECT_EQ(data["preflight"]["pictures"][0]["title"], text);
}

TEST(BakeReport, ViewsHoldTheirPixels) {
    SmallBake bake;
    Image baked(2, 1), reference(2, 1);
    baked.pixels = {{1, 2, 4}, {8, 0.5f, 0.25f}};
    reference.pixels = {{-1, 0, 3}, {5, 6, 7}};
    bake.page.views = {{"front", baked, reference, 64}};
    const std::string html = bake_html(bake.page);
    const auto view = data_of(html)["views"][0];
    const auto pictures = pictures_of(html);
    const auto values = [&](const char* which) {
        std::vector<double> result;
        for (const std::uint16_t word : words_of(pictures[view[which].get<std::string>()], "half"))
            result.push_back(value_of_half(word));
        return result;
    };
    EXPECT_EQ(values("baked"), (std::vector<double>{1, 2, 4, 8, 0.5, 0.25}));
    EXPECT_EQ(values("reference"), (std::vector<double>{-1, 0, 3, 5, 6, 7}));
    EXPECT_EQ(view["samples"], 64);
}

TEST(BakeReport, LayersHoldWhatTexelsHold) {
    const SmallBake bake;
    const std::string html = bake_html(bake.page);
    const auto pictures = pictures_of(html);
    const PageChannels& layout = bake.page.light.channels;
    for (const auto& [name, plane] : std::map<std::string, std::size_t>{
             {"E", layout.irradiance(0)}, {"c0", layout.coefficient(0, 0)}, {"c3", layout.coefficient(3, 0)}})
        for (std::size_t p = 0; p < 2; ++p) {
            const auto& picture = pictures[name + " " + std::to_string(p)];
            const auto words = words_of(picture, "half");
            ASSERT_EQ(words.size(), 3 * bake.pages[p].size());
            for (std::size_t i = 0; i < words.size(); ++i)
                EXPECT_EQ(value_of_half(words[i]), bake.pages[p].planes[plane + i % 3][i / 3]);
        }
    const auto charts = words_of(pictures["charts 1"], "whole");
    for (std::size_t i = 0; i < charts.size(); ++i) EXPECT_EQ(charts[i], bake.pages[1].chart[i]);
    EXPECT_EQ(pictures["validity 0"]["channels"], 1);
}

TEST(BakeReport, LargePagesAreReducedToMeansOfTheirCharts) {
    SmallBake bake(64, 48);
    for (LightmapPage& page : bake.pages)
        for (auto& plane : page.planes)
            for (std::size_t i = 0; i < plane.size(); ++i)
                if (page.chart[i] != 0) plane[i] = 3;
    const std::string html = bake_html(bake.page, {.most_layer_bytes = 60000});
    EXPECT_LT(html.size(), bake_html(bake.page).size() - 100000);
    const auto pictures = pictures_of(html);
    EXPECT_LT(pictures["E 0"]["width"], 64);
    EXPECT_EQ(64 % pictures["E 0"]["width"].get<int>(), 0);
    // Texels between charts do not count.
    for (const std::uint16_t word : words_of(pictures["E 0"], "half")) EXPECT_EQ(value_of_half(word), 3);
}

/// Two heights of 2 x 1 probes with constant light of 1, 2, 3 and 4; the last probe is invalid.
ProbeSet four_probes(const Codec& codec) {
    ProbeSet probes;
    probes.codec = "sh1/moments/convolution";
    probes.coefficients_per_probe = codec.basis().size();
    probes.grid = ProbeGrid{{2, 2, 1}, {0, 0, 0}, {1, 2, 1}};
    for (int i = 0; i < 4; ++i) {
        probes.positions.push_back({static_cast<float>(i % 2), 2 * static_cast<float>(i / 2) + 0.1f, 0});
        probes.validity.push_back(i == 3 ? 0.25f : 1.0f);
        probes.back_faces.push_back(1 - probes.validity.back());
        const auto light = static_cast<float>((i + 1) * std::sqrt(4 * k_pi));
        probes.coefficients.push_back({light, light, light});
        probes.coefficients.resize(probes.coefficients.size() + codec.basis().size() - 1);
    }
    return probes;
}

TEST(ProbePlans, SpheresShowWhatTheirProbesHold) {
    const Codec codec = *make_codec("sh1/moments/convolution");
    const ProbeView view = view_probes(four_probes(codec), codec);
    EXPECT_EQ(view.count, 4u);
    EXPECT_EQ(view.invalid, 1u);
    ASSERT_EQ(view.plans.size(), 2u);
    EXPECT_EQ(view.plans[1].height, 2);
    for (std::size_t k = 0; k < 2; ++k) {
        const ProbePlan& plan = view.plans[k];
        EXPECT_EQ(plan.count, 2u);
        std::size_t covered = 0;
        for (std::size_t i = 0; i < plan.marks.size(); ++i) {
            if (plan.marks[i] == ProbePlan::k_nothing) continue;
            ++covered;
            const bool right = i % plan.image.width >= plan.image.width / 2;
            EXPECT_NEAR(plan.image.pixels[i].g, static_cast<float>(2 * k + 1 + right), 1e-4f);
            EXPECT_EQ(plan.marks[i], k == 1 && right ? ProbePlan::k_invalid : ProbePlan::k_valid);
        }
        // Two discs with a radius of 0.44 of the spacing.
        const double wanted = 2 * k_pi * std::pow(0.44 * 24, 2);
        EXPECT_NEAR(static_cast<double>(covered), wanted, 0.05 * wanted);
    }

    SmallBake bake;
    bake.page.probes = view;
    const std::string html = bake_html(bake.page);
    EXPECT_EQ(data_of(html)["probes"]["invalid"], 1);
    const auto plan = data_of(html)["probes"]["plans"][1];
    EXPECT_EQ(words_of(pictures_of(html)[plan["marks"].get<std::string>()], "whole"), view.plans[1].marks);
}

TEST(ObjectFigures, CountAndAverageValidTexels) {
    const SmallBake bake;
    const auto& objects = bake.page.objects;
    ASSERT_EQ(objects.size(), 3u);
    EXPECT_EQ(objects[0].name, "table");
    EXPECT_EQ(objects[0].texels, 8u);   // chart 1: every third of 24
    EXPECT_EQ(objects[1].texels, 24u);  // charts 2, 3 and 4
    EXPECT_EQ(objects[2].texels, 0u);
    EXPECT_EQ(objects[0].invalid, 4u);
    EXPECT_EQ(objects[1].page, 1u);
    // Valid texels have E = (13, 14, 15) and an error of 16; the codec says 14 everywhere.
    EXPECT_EQ(objects[0].irradiance, (Rgb{13, 14, 15}));
    const double y = luminance(Rgb{13, 14, 15});
    EXPECT_NEAR(objects[0].standard_error, 16 / y, 1e-6);
    EXPECT_NEAR(objects[0].codec_error, std::abs(14 - y) / y, 1e-5);
    EXPECT_EQ(objects[0].box.x0, 0);
    EXPECT_EQ(objects[0].box.x1, 4);  // columns 0 and 3 of six
    EXPECT_EQ(objects[0].box.y1, 4);
}

TEST(ObjectFigures, ChartsBelongToTheirObjects) {
    const Scene scene = cornell_scene();
    const World world = make_world(scene);
    const Atlas atlas = *Atlas::make(world, {});
    const auto objects = preflight(atlas, map_texels(atlas)).object_of_chart;
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        const std::uint32_t chart = atlas.chart_of_triangle()[t];
        if (chart == Atlas::k_no_chart) continue;
        EXPECT_EQ(objects[chart], world.object[t]);
    }
}

TEST(RenderViews, ShowEveryCameraFromBothSides) {
    const Scene scene = cornell_scene();
    SmallBake bake;
    bake.placements.assign(scene.objects.size(), {});
    RenderOptions options;
    options.width = 9;
    options.height = 8;
    options.samples = 2;
    bake.page.light.placements = bake.placements;
    const auto views = render_views(scene, bake.page.light, {}, options);
    ASSERT_TRUE(views);
    ASSERT_EQ(views->size(), scene.cameras.size());
    // No object has a lightmap here, so both pictures are path-traced.
    EXPECT_EQ(views->front().baked.pixels, views->front().reference.pixels);
    EXPECT_EQ(views->front().camera, scene.cameras.front().name);
    EXPECT_EQ(views->front().reference_samples, 2u);
}

}  // namespace
}  // namespace lobelia
