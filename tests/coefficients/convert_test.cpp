// Tests conversions between coefficient files and the conventions of other programs, as one call.
#include "coefficients/convert.h"

#include <gtest/gtest.h>

#include <cmath>

#include "coefficients/coefficient_file.h"
#include "lobelia/sh_conventions.h"

namespace lobelia {
namespace {

CoefficientFile sample_file(const char* codec_name) {
    const Codec codec = make_codec(codec_name).value();
    CoefficientFile file{codec.name(), {}};
    for (std::size_t i = 0; i < codec.basis().size(); ++i) {
        const auto x = static_cast<float>(i + 1);
        file.c.push_back({x, -x / 2, 0.25f});
    }
    return file;
}

TEST(Convert, EveryConventionRoundTrips) {
    const CoefficientFile file = sample_file("sh2/least-squares/convolution");
    for (const ShConvention& convention : sh_conventions()) {
        const std::string name(convention.name);
        SCOPED_TRACE(name);
        const auto theirs = convert(to_text(file), "ours.json", {.to = name});
        ASSERT_TRUE(theirs) << theirs.error().message;
        EXPECT_TRUE(theirs->warnings.empty());
        const auto ours = convert(theirs->text, "theirs.json", {.from = name, .codec = file.codec.str()});
        ASSERT_TRUE(ours) << ours.error().message;
        const auto read = coefficients_from_text(ours->text, "back.json");
        ASSERT_TRUE(read);
        EXPECT_EQ(read->codec, file.codec);
        for (std::size_t i = 0; i < file.c.size(); ++i)
            for (const auto channel : {&Rgb::r, &Rgb::g, &Rgb::b})
                EXPECT_NEAR(read->c[i].*channel, file.c[i].*channel, 1e-5f * std::abs(file.c[i].*channel)) << i;
    }
}

TEST(Convert, MirroringTwiceChangesNothing) {
    const CoefficientFile file = sample_file("sh2/least-squares/convolution");
    for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
        const auto once = convert(to_text(file), "a", {.to = "unity", .mirrored = axis});
        ASSERT_TRUE(once);
        EXPECT_NE(once->text, convert(to_text(file), "a", {.to = "unity"})->text);
        const auto twice = convert(once->text, "b", {.from = "unity", .mirrored = axis, .codec = file.codec.str()});
        ASSERT_TRUE(twice);
        const auto read = coefficients_from_text(twice->text, "c");
        ASSERT_TRUE(read);
        // Factors of the other convention round once in each direction.
        for (std::size_t i = 0; i < file.c.size(); ++i)
            for (const auto channel : {&Rgb::r, &Rgb::g, &Rgb::b})
                EXPECT_NEAR(read->c[i].*channel, file.c[i].*channel, 1e-5f * std::abs(file.c[i].*channel)) << i;
    }
}

TEST(Convert, DegreesThatAreLeftOutAreReported) {
    const auto converted =
        convert(to_text(sample_file("sh4/least-squares/convolution")), "probe.json", {.to = "unity"});
    ASSERT_TRUE(converted);
    ASSERT_EQ(converted->warnings.size(), 1u);
    EXPECT_NE(converted->warnings[0].find("probe.json: unity has no degrees above 2"), std::string::npos);
}

TEST(Convert, RefusesWhatItCannotConvert) {
    const std::string harmonics = to_text(sample_file("sh2/least-squares/convolution"));
    const std::string lobes = to_text(sample_file("sg12/least-squares/hill"));
    const auto message = [](const std::string& text, const ConvertOptions& options) {
        const auto result = convert(text, "c.json", options);
        return result ? std::string("converted") : result.error().message;
    };
    EXPECT_NE(message(harmonics, {}).find("--from, --to or both"), std::string::npos);
    EXPECT_NE(message(harmonics, {.to = "unit"}).find("unity"), std::string::npos);
    EXPECT_NE(message(lobes, {.to = "unity"}).find("no spherical harmonics"), std::string::npos);
    const auto theirs = convert(harmonics, "c.json", {.to = "gltf"});
    ASSERT_TRUE(theirs);
    EXPECT_NE(message(theirs->text, {.from = "gltf", .codec = "sh4/least-squares/convolution"}).find("9 spherical"),
              std::string::npos);
}

}  // namespace
}  // namespace lobelia
