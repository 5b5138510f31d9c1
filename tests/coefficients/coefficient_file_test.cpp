// Tests that coefficient files read back bit for bit, and that every kind of bad file is refused.
#include "coefficients/coefficient_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

namespace lobelia {
namespace {

using nlohmann::json;

json good_file() {
    CoefficientFile file{{"sh1", "least-squares", "convolution"}, {}};
    for (int i = 0; i < 4; ++i) file.c.push_back({static_cast<float>(i) / 3, -1e-30f, 1e30f});
    return json::parse(to_text(file));
}

TEST(CoefficientFiles, RoundTrip) {
    for (const char* name : {"sg12/nnls/hill", "sh8/moments/convolution", "sg5h/joint/exact"}) {
        const Codec codec = make_codec(name).value();
        CoefficientFile file{codec.name(), {}};
        std::mt19937 generator(1);
        for (std::size_t i = 0; i < codec.basis().size(); ++i)
            file.c.push_back({static_cast<float>(generator()), -1 / static_cast<float>(generator()), 0});
        for (const int indent : {-1, 2}) {
            const auto read = coefficients_from_text(json::parse(to_text(file)).dump(indent), "c.json");
            ASSERT_TRUE(read) << name;
            EXPECT_EQ(read->codec, file.codec);
            EXPECT_EQ(read->c, file.c);  // to the bit
        }
    }
}

void expect_refused(const std::string& text, const std::string& what, const std::string& part = "") {
    const auto read = coefficients_from_text(text, "folder/c.json");
    ASSERT_FALSE(read) << what;
    EXPECT_TRUE(read.error().message.starts_with("folder/c.json: ")) << read.error().message;
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
}

TEST(CoefficientFiles, EveryKindOfBadFileNamesTheFile) {
    ASSERT_TRUE(coefficients_from_text(good_file().dump(), "folder/c.json"));
    const auto refuse = [](const char* what, const std::function<void(json&)>& spoil, const std::string& part = "") {
        json file = good_file();
        spoil(file);
        expect_refused(file.dump(), what, part);
    };
    refuse(
        "too few", [](json& f) { f["coefficients"].erase(0); }, "4");
    refuse(
        "too many",
        [](json& f) {
            f["coefficients"].push_back({1, 2, 3});
        },
        "5");
    refuse("none", [](json& f) { f["coefficients"] = json::array(); });
    refuse("no array", [](json& f) { f["coefficients"] = 3; });
    refuse("missing", [](json& f) { f.erase("coefficients"); });
    refuse("object", [](json& f) { f["coefficients"] = {{"a", 1}}; });
    refuse(
        "null", [](json& f) { f["coefficients"][2][1] = nullptr; }, "2");
    refuse(
        "string", [](json& f) { f["coefficients"][2][1] = "1"; }, "2");
    refuse(
        "bool", [](json& f) { f["coefficients"][2][1] = true; }, "2");
    refuse(
        "pair",
        [](json& f) {
            f["coefficients"][1] = {1, 2};
        },
        "1");
    refuse(
        "four",
        [](json& f) {
            f["coefficients"][1] = {1, 2, 3, 4};
        },
        "1");
    refuse(
        "number", [](json& f) { f["coefficients"][1] = 1; }, "1");
    refuse(
        "beyond float32", [](json& f) { f["coefficients"][3][0] = 1e39; }, "3");
    refuse(
        "NaN, which is written as null", [](json& f) { f["coefficients"][3][0] = std::nan(""); }, "3");
    refuse(
        "unknown codec", [](json& f) { f["codec"] = "sh1/least-squares/convolutio"; }, "did you mean");
    refuse(
        "unknown basis", [](json& f) { f["codec"] = "sh9/least-squares/convolution"; }, "sh9");
    refuse("no name", [](json& f) { f["codec"] = ""; });
    refuse("codec of another type", [](json& f) { f["codec"] = 7; });
    refuse("no codec", [](json& f) { f.erase("codec"); });
    refuse(
        "newer version", [](json& f) { f["lobelia_coefficients"] = 2; }, "version");
    refuse(
        "version 0", [](json& f) { f["lobelia_coefficients"] = 0; }, "version");
    refuse(
        "huge version", [](json& f) { f["lobelia_coefficients"] = 18446744073709551615u; }, "version");
    refuse("version as text", [](json& f) { f["lobelia_coefficients"] = "1"; });
    refuse("no version", [](json& f) { f.erase("lobelia_coefficients"); });
}

TEST(CoefficientFiles, WhatIsNoJsonIsRefused) {
    for (const char* text : {"", " ", "null", "[]", "3", "\"text\"", "{", "}", "{\"a\":}", "NaN", "\xff\xfe",
                             "// a comment", "{\"lobelia_coefficients\": NaN}", "{\"lobelia_coefficients\": 1e999}"})
        expect_refused(text, text);
    expect_refused(std::string("\0\0\0", 3), "zeros");
    expect_refused("#?RADIANCE\n", "a picture");
}

TEST(CoefficientFiles, TruncatedAtAnyByteIsRefused) {
    const std::string text = good_file().dump(2);
    for (std::size_t size = 0; size < text.size(); ++size) expect_refused(text.substr(0, size), std::to_string(size));
    expect_refused(text + text, "two files in one");
}

TEST(CoefficientFiles, DeepNestingIsRefusedNotFollowed) {
    constexpr std::size_t depth = 200000;
    const std::string open(depth, '['), close(depth, ']');
    expect_refused(open, "open");
    expect_refused(open + close, "closed");
    const std::string head = R"({"lobelia_coefficients": 1, "codec": "sh1/least-squares/convolution", )";
    expect_refused(head + "\"coefficients\": " + open + close + "}", "in place of coefficients");
    expect_refused(head + "\"coefficients\": [" + open + close + ", [1,2,3], [1,2,3], [1,2,3]]}", "as a coefficient");
    expect_refused("{\"lobelia_coefficients\": " + open + close + "}", "in place of the version");
    std::string objects;
    for (std::size_t i = 0; i < 100000; ++i) objects += "{\"codec\":";
    expect_refused(objects, "objects");
}

}  // namespace
}  // namespace lobelia
