// Tests Radiance pictures: every scheme and orientation decodes to the same radiance, and damage is reported, never
// repaired by guessing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "data.h"
#include "image_reading.h"
#include "io/read_image.h"
#include "io/write_file.h"
#include "io_files.h"

namespace lobelia {
namespace {

using test::message_of;
using test::warns_of;

using Scheme = HdrSpec::Scheme;
constexpr std::array k_schemes{Scheme::flat, Scheme::old_rle, Scheme::new_rle};
constexpr std::array k_axes{"-Y +X", "-Y -X", "+Y +X", "+Y -X", "+X -Y", "+X +Y", "-X -Y", "-X +Y"};

Result<LoadedImage> read_hdr_bytes(const std::string& bytes, const ReadOptions& options = {}) {
    return read_hdr(std::as_bytes(std::span(bytes)), "picture.hdr", options);
}

/// A texel's radiances from their definition.
Rgb value_of(const HdrTexels::Texel& t) {
    const auto component = [&](std::uint8_t m) {
        return t[3] == 0 ? 0 : static_cast<float>(std::ldexp(m, t[3] - 136));
    };
    return {component(t[0]), component(t[1]), component(t[2])};
}

bool holds(const Image& image, const HdrTexels& picture) {
    return image.width == picture.width && image.height == picture.height &&
           std::equal(image.pixels.begin(), image.pixels.end(), picture.texels.begin(), picture.texels.end(),
                      [](const Rgb& pixel, const auto& texel) { return pixel == value_of(texel); });
}

HdrTexels one_texel(HdrTexels::Texel texel) { return {2, 1, {texel, texel}}; }

TEST(ReadHdr, RoundTripOfEverySchemeAndOrientation) {
    const HdrTexels picture = test_texels(40, 20);
    for (const Scheme scheme : k_schemes) {
        for (const char* axes : k_axes) {
            const auto loaded = read_hdr_bytes(make_hdr(picture, {scheme, axes, "FORMAT=32-bit_rle_rgbe\n"}));
            ASSERT_TRUE(loaded) << message_of(loaded);
            EXPECT_TRUE(holds(loaded->image, picture)) << axes << " scheme " << static_cast<int>(scheme);
            EXPECT_TRUE(loaded->warnings.empty());
        }
    }
}

TEST(ReadHdr, RoundTripOfEveryWidth) {
    for (const std::size_t width : {1, 2, 7, 8, 9, 127, 128, 129, 255, 256, 257, 300, 2000}) {
        for (const Scheme scheme : k_schemes) {
            if (scheme == Scheme::new_rle && width < 8) continue;
            const HdrTexels picture = test_texels(width, 2);
            const auto loaded = read_hdr_bytes(make_hdr(picture, {.scheme = scheme}));
            ASSERT_TRUE(loaded) << message_of(loaded);
            EXPECT_TRUE(holds(loaded->image, picture)) << width;
        }
    }
}

TEST(ReadHdr, LongRunsOfOneColour) {
    // Runs above 255 take two or three instructions of the old scheme; 40000 is beyond what the new one may hold.
    for (const std::size_t width : {256, 257, 511, 512, 8192, 40000}) {
        const HdrTexels picture{width, 1, std::vector<HdrTexels::Texel>(width, {200, 100, 50, 130})};
        const auto loaded = read_hdr_bytes(make_hdr(picture, {.scheme = Scheme::old_rle}));
        ASSERT_TRUE(loaded) << message_of(loaded);
        EXPECT_TRUE(holds(loaded->image, picture)) << width;
    }
}

TEST(ReadHdr, ExposureAndColourCorrectionAreDividedOut) {
    const std::string variables = "EXPOSURE=  2.0\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=4\nCOLORCORR= 1 2 0.5\n";
    const auto loaded = read_hdr_bytes(make_hdr(one_texel({128, 128, 128, 129}), {Scheme::flat, "-Y +X", variables}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_EQ(loaded->image.pixels[0], (Rgb{1.0f / 8, 1.0f / 16, 1.0f / 4}));
}

TEST(ReadHdr, GreyOfXyzeIsGrey) {
    // Radiance's white is equal energy, and its XYZE holds candela per square metre: 128 / 128 / 179 everywhere.
    const auto loaded =
        read_hdr_bytes(make_hdr(one_texel({128, 128, 128, 129}), {Scheme::flat, "-Y +X", "FORMAT=32-bit_rle_xyze\n"}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    for (const float component : {loaded->image.pixels[0].r, loaded->image.pixels[0].g, loaded->image.pixels[0].b})
        EXPECT_NEAR(component, 1.0 / 179, 1e-6);
}

TEST(ReadHdr, PrimaryOfXyzeIsPure) {
    // Rec. 709's red is x = 0.64, y = 0.33, z = 0.03, and its white is stated; hence no adaptation.
    const std::string variables =
        "FORMAT=32-bit_rle_xyze\nPRIMARIES= .64 .33 .30 .60 .15 .06 .3127 .3290\nEXPOSURE=0.00558659218\n";
    const auto loaded = read_hdr_bytes(make_hdr(one_texel({128, 66, 6, 129}), {Scheme::flat, "-Y +X", variables}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_NEAR(loaded->image.pixels[0].g, 0, 1e-5);
    EXPECT_NEAR(loaded->image.pixels[0].b, 0, 1e-5);
    EXPECT_NEAR(luminance(loaded->image.pixels[0]), 66.0 / 128, 1e-4);
}

TEST(ReadHdr, OnlyForeignPrimariesWarn) {
    const auto warns = [](const std::string& primaries) {
        const std::string variables = "PRIMARIES=" + primaries + "\nFORMAT=32-bit_rle_rgbe\n";
        const auto loaded = read_hdr_bytes(make_hdr(test_texels(8, 4), {Scheme::flat, "-Y +X", variables}));
        return loaded && warns_of(*loaded, "PRIMARIES");
    };
    EXPECT_FALSE(warns("0 0 0 0 0 0 0 0"));
    EXPECT_FALSE(warns("0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290"));
    EXPECT_FALSE(warns("0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333"));
    EXPECT_TRUE(warns("0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290"));
}

TEST(ReadHdr, OddShapesAndTrailingBytesWarn) {
    const auto loaded = read_hdr_bytes(make_hdr(test_texels(9, 9)) + "more");
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(warns_of(*loaded, "2 : 1"));
    EXPECT_TRUE(warns_of(*loaded, "4 bytes after"));
}

TEST(ReadHdr, TruncatedAtEveryByteIsAnError) {
    for (const Scheme scheme : k_schemes) {
        const std::string whole = make_hdr(test_texels(20, 4), {.scheme = scheme});
        for (std::size_t length = 0; length < whole.size(); ++length) {
            const auto loaded = read_hdr_bytes(whole.substr(0, length));
            ASSERT_FALSE(loaded) << length;
            EXPECT_EQ(message_of(loaded).rfind("picture.hdr: ", 0), 0u);
            const std::string expected = length > 2 ? "the file ends" : "at byte";
            EXPECT_NE(message_of(loaded).find(expected), std::string::npos) << message_of(loaded);
        }
    }
}

TEST(ReadHdr, ImpossibleSizesAreRefused) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    for (const char* size : {"-Y 0 +X 0", "-Y 0 +X 5", "-Y -4 +X 8", "-Y 100000 +X 100000", "-Y 65536 +X 65536",
                             "-Y 4 +Y 8", "-Y 4", "-Y 4 +X", "-Y 4 +X 8 +Z 2", "Y 4 X 8", "-Y 4x +X 8",
                             "-Y 99999999999999999999 +X 1", "-Y 9223372036854775807 +X 9223372036854775807", ""})
        EXPECT_FALSE(read_hdr_bytes(header + size + "\n" + std::string(64, '\x7f'))) << size;
    // This size is allowed, but so few bytes cannot hold it: it must fail before 3 GB are allocated.
    const auto loaded = read_hdr_bytes(header + "-Y 16384 +X 16384\n" + std::string(64, '\x7f'));
    EXPECT_NE(message_of(loaded).find("cannot hold 16384 x 16384"), std::string::npos) << message_of(loaded);
}

TEST(ReadHdr, DamagedVariablesAreErrors) {
    for (const char* line :
         {"EXPOSURE=0", "EXPOSURE=-1", "EXPOSURE=nan", "EXPOSURE=x", "EXPOSURE=1e300", "COLORCORR=1 2",
          "PRIMARIES=1 2 3", "PRIMARIES=.64 .33 .3 .6 .15 .06 0 0", "FORMAT=32-bit_rle_cmyk"}) {
        const auto loaded =
            read_hdr_bytes(make_hdr(test_texels(8, 4), {Scheme::flat, "-Y +X", std::string(line) + "\n"}));
        EXPECT_NE(message_of(loaded).find("at byte 11"), std::string::npos) << line << ": " << message_of(loaded);
    }
}

TEST(ReadHdr, DamagedRunsNameTheScanline) {
    const auto damaged = [](Scheme scheme, const std::function<void(std::string&, std::size_t)>& damage) {
        const HdrTexels picture{16, 4, std::vector<HdrTexels::Texel>(64, {128, 64, 32, 130})};
        std::string bytes = make_hdr(picture, {.scheme = scheme});
        const std::size_t scanline = (bytes.size() - bytes.find("+X 16\n") - 6) / 4;
        damage(bytes, bytes.size() - 2 * scanline);
        return message_of(read_hdr_bytes(bytes));
    };
    const auto set = [](std::size_t offset, char value) {
        return [=](std::string& bytes, std::size_t begin) { bytes[begin + offset] = value; };
    };
    for (const std::string& message : {damaged(Scheme::new_rle, set(3, 17)),      // another length
                                       damaged(Scheme::new_rle, set(4, 0)),       // a packet of nothing
                                       damaged(Scheme::new_rle, set(4, '\xff')),  // a run too long
                                       damaged(Scheme::new_rle, set(4, 17)),      // too many literals
                                       damaged(Scheme::old_rle, set(7, 16)),      // a run too long
                                       damaged(Scheme::old_rle, [](std::string&bytes, std::size_t begin) {
                                           bytes.replace(begin, 4, "\1\1\1\5");  // a run of nothing
                                       })})
        EXPECT_NE(message.find("scanline 2 of 4"), std::string::npos) << message;
}

TEST(ReadEnvironment, WhatIsNoImageIsToldApart) {
    const std::filesystem::path folder = ::testing::TempDir();
    const auto message = [&](const std::string& name) { return message_of(read_environment(folder / name)); };
    ASSERT_TRUE(write_file_atomically(folder / "empty.hdr", std::string_view()));
    ASSERT_TRUE(write_file_atomically(folder / "text.hdr", std::string_view("hello, this is no image")));
    ASSERT_TRUE(write_file_atomically(folder / "head.hdr", std::string_view("#?RADIANCE\n")));
    EXPECT_NE(message("missing.hdr").find("No such file"), std::string::npos);
    EXPECT_NE(message(".").find("folder"), std::string::npos);
    EXPECT_NE(message("empty.hdr").find("empty"), std::string::npos);
    EXPECT_NE(message("text.hdr").find("neither"), std::string::npos);
    EXPECT_NE(message("head.hdr").find("within its header"), std::string::npos);
}

TEST(ReadEnvironment, ContentDecidesTheFormat) {
    const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "misnamed.exr";
    const HdrTexels picture = test_texels(16, 8);
    ASSERT_TRUE(write_file_atomically(path, make_hdr(picture)));
    const auto loaded = read_environment(path);
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_TRUE(holds(loaded->image, picture));
}

TEST(ReadEnvironment, RealEnvironments) {
    const std::filesystem::path folder = test::data_folder();
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no " << folder << ": set LOBELIA_DATA to a folder with latitude-longitude .hdr files";
    std::size_t read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".hdr") continue;
        const auto loaded = read_environment(entry.path());
        ASSERT_TRUE(loaded) << message_of(loaded);
        EXPECT_TRUE(loaded->warnings.empty()) << entry.path();
        EXPECT_EQ(loaded->image.width, 2 * loaded->image.height);
        ++read;
    }
    EXPECT_GT(read, 0u);
}

}  // namespace
}  // namespace lobelia
