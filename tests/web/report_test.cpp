// Tests the reports of comparisons and studies: they load nothing, no string escapes from its script element, pictures
// keep their values.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/write_image.h"
#include "page_support.h"
#include "report/bake_report.h"
#include "report/base64.h"
#include "report/comparison_report.h"
#include "report/study_report.h"

namespace lobelia {
namespace {

using namespace test;

nlohmann::json small_report(const std::string& name) {
    return {
        {"lobelia", "0.1.0"}, {"format", 1}, {"environment", {{"name", name}}}, {"methods", nlohmann::json::array()}};
}

TEST(HalfFloat, EveryHalfRoundTrips) {
    for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
        const double value = value_of_half(static_cast<std::uint16_t>(bits));
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(half_from_float(static_cast<float>(value)), bits);
    }
}

TEST(HalfFloat, RoundsToNearestTiesToEven) {
    for (std::uint16_t bits = 0; bits < 0x7bff; ++bits) {
        const double low = value_of_half(bits), high = value_of_half(static_cast<std::uint16_t>(bits + 1));
        const auto middle = static_cast<float>((low + high) / 2);
        ASSERT_EQ(half_from_float(std::nextafter(middle, 0.0f)), bits);
        ASSERT_EQ(half_from_float(std::nextafter(middle, 1e9f)), bits + 1);
        ASSERT_EQ(half_from_float(middle), bits + (bits & 1));
    }
}

TEST(HalfFloat, ClampsHugeValuesAndKeepsNotANumber) {
    for (const float huge : {65504.0f, 65519.9f, 65520.0f, 1e10f, std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(value_of_half(half_from_float(huge)), 65504.0);
        EXPECT_EQ(value_of_half(half_from_float(-huge)), -65504.0);
    }
    EXPECT_TRUE(std::isnan(value_of_half(half_from_float(std::numeric_limits<float>::quiet_NaN()))));
    EXPECT_EQ(half_from_float(1e-30f), 0);
}

TEST(Picture, RoundTripsNegativeTinyAndHugeValues) {
    const std::vector<Rgb> pixels = {{-1.5f, 0x1p-24f, 1e9f}, {0, -0x1p-14f, -1e9f}, {0.25f, 1024, 6e-5f}};
    const auto values = values_of(encode_picture(pixels, 3, 1));
    ASSERT_EQ(values.size(), 9u);
    EXPECT_EQ((std::vector<double>(values.begin(), values.end() - 1)),
              (std::vector<double>{-1.5, 0x1p-24, 65504, 0, -0x1p-14, -65504, 0.25, 1024}));
    EXPECT_NEAR(values[8], 6e-5, 0x1p-25);
}

TEST(Picture, PlanesGiveWhatPixelsGive) {
    const std::vector<Rgb> pixels = {{1, 2, 3}, {-4, 5, 6}, {7, 8, -9}, {10, 11, 12}, {13, 14, 15}, {0, 0, 0.1f}};
    Colours colours(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) set_entry(colours.view(), i, pixels[i]);
    const Picture from_planes = encode_picture(ColourView(colours), 3, 2), from_pixels = encode_picture(pixels, 3, 2);
    EXPECT_EQ(from_planes.data, from_pixels.data);
    EXPECT_EQ(from_planes.width, 3u);
    EXPECT_EQ(from_planes.height, 2u);
}

/// Bytes of every value, in a line that has no period of three.
std::string all_bytes(std::size_t count) {
    std::string bytes;
    for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(i * 37 % 256);
    return bytes;
}

Study small_study(const std::string& title) {
    Study study;
    study.name = "small";
    study.title = title;
    study.summary = "Of " + title;
    study.tables = {{title, "note of " + title, {"encoder", title}, {{title, "0.5 / 0.25"}, {"moments", "1 / 2"}}}};
    study.plots = {{title, "", "samples", "error", Study::Axis::logarithmic, Study::Axis::linear, {}}};
    study.plots[0].series = {{"numeric integral", {1, 2, 4}, {0.5, 0, -1}}, {title, {1, 2}, {3, std::nan("")}}};
    study.pictures = {{title, "sharpness 1, exact", Image(3, 2)}};
    study.pictures[0].image.pixels[4] = {1, 0.5f, 0};
    return study;
}

std::string page_of(const Study& study) {
    const auto html = study_html(study);
    EXPECT_TRUE(html);
    return html ? *html : std::string();
}

TEST(Base64, RoundTripsAndPads) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    for (const std::size_t count : {255u, 256u, 257u}) {
        const std::string bytes = all_bytes(count), text = base64(bytes);
        EXPECT_EQ(text.size() % 4, 0u);
        const auto back = bytes_of_base64(text.substr(0, text.find('=')));
        EXPECT_EQ(std::string(back.begin(), back.end()), bytes);
    }
}

TEST(ReportPage, LoadsNothing) { expect_loads_nothing(comparison_html(small_report("sky.hdr"), {})); }
TEST(ReportPage, FillsEveryMark) { expect_filled(comparison_html(small_report("sky.hdr"), {})); }

TEST(ReportPage, NoNameEndsItsScriptElement) {
    const std::string name = "</script><script>alert(1)</script><!-- \"quoted\" \\ .hdr";
    PictureSet pictures;
    pictures.radiance[name] = encode_picture(std::array{Rgb{1, 2, 3}}, 1, 1);
    pictures.references[name] = {pictures.radiance[name], pictures.radiance[name]};
    const std::string html = comparison_html(small_report(name), pictures);

    EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(script_element(html, "report-data")), small_report(name));
    const auto parsed = nlohmann::json::parse(script_element(html, "picture-data"));
    EXPECT_EQ(parsed["radiance"][name]["half"], pictures.radiance[name].data);
    EXPECT_EQ(parsed["references"][name]["irradiance_over_pi"]["width"], 1);
    EXPECT_TRUE(parsed["irradiance_over_pi"].empty());
}

TEST(ReportPage, ReplacesBytesThatAreNotUtf8) {
    const std::string html = comparison_html(small_report("caf\xe9.hdr"), {});
    EXPECT_EQ(nlohmann::json::parse(script_element(html, "report-data"))["environment"]["name"], "caf\uFFFD.hdr");
}

/// The last script of a report, which holds its modules.
std::string module_script(const std::string& html) {
    const std::string open = "<script type=\"module\">\n";
    const std::size_t begin = html.find(open) + open.size();
    return html.substr(begin, html.find("</script", begin) - begin);
}

TEST(JoinedModules, HoldEachModuleOnceAfterItsImports) {
    const std::vector<std::string> scripts = {module_script(comparison_html(small_report("sky.hdr"), {})),
                                              module_script(page_of(small_study("Lobes"))),
                                              module_script(bake_html({}))};
    for (const std::string& script : scripts) {
        for (const char* statement : {"\nimport ", "\nexport "}) EXPECT_EQ(script.find(statement), std::string::npos);
        // The elements are used by all modules after them.
        const std::string declaration = "function element(";
        const std::size_t at = script.find(declaration);
        ASSERT_NE(at, std::string::npos);
        EXPECT_EQ(script.find(declaration, at + 1), std::string::npos);
    }
    EXPECT_LT(scripts[0].find("function figure_text("), scripts[0].find("function build_method_table("));
}

TEST(Licences, ReportsThatHoldChartJsHoldItsLicence) {
    const std::string comparison = comparison_html(small_report("sky.hdr"), {}), study = page_of(small_study("Lobes"));
    for (const std::string& html : {comparison, study}) {
        EXPECT_NE(html.find("Chart.js v3"), std::string::npos);
        EXPECT_NE(html.find("Permission is hereby granted, free of charge"), std::string::npos);
        EXPECT_NE(html.find("Chart.js Contributors"), std::string::npos);
    }
    EXPECT_EQ(bake_html({}).find("Chart.js"), std::string::npos);
}

TEST(StudyPage, LoadsNothing) { expect_loads_nothing(page_of(small_study("Lobes"))); }
TEST(StudyPage, FillsEveryMark) { expect_filled(page_of(small_study("Lobes"))); }

TEST(StudyPage, HoldsAllTablesAndSeries) {
    const Study study = small_study("Lobes");
    auto data = nlohmann::json::parse(script_element(page_of(study), "study-data"));
    EXPECT_EQ(data["plots"][0]["series"][0]["name"], "numeric integral");
    EXPECT_EQ(data["plots"][0]["series"][0]["y"], (std::vector<double>{0.5, 0, -1}));
    EXPECT_TRUE(data["plots"][0]["series"][1]["y"][1].is_null());  // not a number
    EXPECT_EQ(data["plots"][0]["x_axis"], "logarithmic");
    // All data of the report equals to_json(), written as JSON.
    data.erase("pictures"), data.erase("lobelia");
    EXPECT_EQ(data, nlohmann::json::parse(to_json(study).dump()));
}

TEST(StudyPage, HoldsPicturesAsPng) {
    const Study study = small_study("Lobes");
    const auto data = nlohmann::json::parse(script_element(page_of(study), "study-data"));
    const std::string source = data["pictures"][0]["source"], head = "data:image/png;base64,";
    ASSERT_EQ(source.substr(0, head.size()), head);
    const std::string text = source.substr(head.size());
    const auto bytes = bytes_of_base64(text.substr(0, text.find('=')));
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()), *encode_png(to_srgb(study.pictures[0].image)));
    EXPECT_FALSE(to_json(study).contains("pictures"));
}

TEST(StudyPage, NoTextEndsItsScriptElement) {
    const std::string text = "</script><script>alert(1)</script><!-- \"quoted\" \\ {{study}} {{page.css}}";
    const std::string html = page_of(small_study(text));
    EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
    const auto data = nlohmann::json::parse(script_element(html, "study-data"));
    EXPECT_EQ(data["title"], text);
    EXPECT_EQ(data["tables"][0]["rows"][0][0], text);
    EXPECT_EQ(data["plots"][0]["series"][1]["name"], text);
    EXPECT_EQ(data["pictures"][0]["title"], text);
}

TEST(StudyPage, RefusesPicturesWithoutPixels) {
    Study study = small_study("Lobes");
    study.pictures[0].image = {};
    const auto html = study_html(study);
    ASSERT_FALSE(html);
    EXPECT_NE(html.error().message.find("Lobes"), std::string::npos);
}

}  // namespace
}  // namespace lobelia
