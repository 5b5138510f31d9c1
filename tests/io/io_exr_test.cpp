// OpenEXR: every compression, pixel type and layout decodes to the same image, and damage never gives a partial one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "io/read_image.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "io_files.h"

namespace lobelia {
namespace {

using Layout = ExrSpec::Layout;

Result<LoadedImage> read(const std::string& bytes, const ReadOptions& options = {}) {
    return read_exr(std::as_bytes(std::span(bytes)), "picture.exr", options);
}

std::string message_of(const Result<LoadedImage>& result) { return result ? "" : result.error().message; }

bool warns_of(const LoadedImage& loaded, const std::string& word) {
    return std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                       [&](const std::string& w) { return w.find(word) != std::string::npos; });
}

double largest_difference(const Image& a, const Image& b) {
    if (a.pixels.size() != b.pixels.size() || a.width != b.width) return HUGE_VAL;
    float largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        largest = std::max({largest, std::abs(a.pixels[i].r - b.pixels[i].r), std::abs(a.pixels[i].g - b.pixels[i].g),
                            std::abs(a.pixels[i].b - b.pixels[i].b)});
    return largest;
}

bool is_lossy(Imf::Compression compression, Imf::PixelType type) {
    const bool blocks = compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION;
    const bool cosines = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    return (blocks && type == Imf::HALF) || (cosines && type != Imf::UINT);
}

TEST(ReadExr, RoundTripOfEveryCompressionTypeAndLayout) {
    const Image image = test_image(40, 20);
    for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
            for (const Layout layout : {Layout::scan_lines, Layout::tiles, Layout::mipmap, Layout::ripmap}) {
                const auto compression = static_cast<Imf::Compression>(c);
                const auto loaded = read(make_exr(image, {.layout = layout, .compression = compression, .type = type}));
                ASSERT_TRUE(loaded) << message_of(loaded);
                // Whole numbers survive all but the lossy schemes, which keep about 5 bits of this noise.
                EXPECT_LE(largest_difference(loaded->image, image), is_lossy(compression, type) ? 2 : 0)
                    << "compression " << c << " type " << type << " layout " << static_cast<int>(layout);
            }
        }
    }
}

TEST(ReadExr, ZerosOfLossyFilesAreNotNegative) {
    Image image = test_image(40, 20);
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) image.pixels[i] = {};
    for (const Imf::Compression compression : {Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        const auto loaded = read(make_exr(image, {.compression = compression}));
        EXPECT_TRUE(loaded) << message_of(loaded);
    }
}

TEST(ReadExr, DataWindowsAnywhere) {
    const Image image = test_image(20, 10);
    for (const int left : {-1000, -7, 0, 3, 100000}) {
        for (const Layout layout : {Layout::scan_lines, Layout::tiles}) {
            const auto loaded = read(make_exr(image, {.layout = layout, .left = left, .top = -2 * left}));
            ASSERT_TRUE(loaded) << message_of(loaded);
            EXPECT_EQ(loaded->image.pixels, image.pixels) << left;
        }
    }
}

TEST(ReadExr, LuminanceIsGrey) {
    const Image image = test_image(16, 8);
    const auto loaded = read(make_exr(image, {.channels = {"Y"}}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_EQ(loaded->image.pixels[i], (Rgb{image.pixels[i].r, image.pixels[i].r, image.pixels[i].r}));
}

TEST(ReadExr, LuminanceAndChroma) {
    // Chroma is stored at half rate: a plain colour comes back.
    Image image(16, 8);
    std::fill(image.pixels.begin(), image.pixels.end(), Rgb{4, 2, 1});
    const auto loaded = read(make_luminance_chroma_exr(image));
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_LE(largest_difference(loaded->image, image), 0.02);
}

TEST(ReadExr, FirstPartWithColourIsRead) {
    const Image image = test_image(16, 8);
    const auto parts = read(make_multi_part_exr(image, {{"Z"}, {"R", "G", "B", "A"}, {"Y"}}));
    ASSERT_TRUE(parts) << message_of(parts);
    EXPECT_EQ(parts->image.pixels, image.pixels);
    EXPECT_TRUE(warns_of(*parts, "read part 1 (\"part 1\") of 3"));
    // Layers count only where no part has plain channels.
    const auto layered = read(make_multi_part_exr(image, {{"left.R", "left.G", "left.B"}, {"Y"}}));
    ASSERT_TRUE(layered) << message_of(layered);
    EXPECT_TRUE(warns_of(*layered, "read part 1"));
}

TEST(ReadExr, LayersAreTheFallback) {
    const Image image = test_image(16, 8);
    const auto loaded = read(make_exr(image, {.channels = {"left.R", "left.G", "left.B"}}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_EQ(loaded->image.pixels, image.pixels);
    EXPECT_TRUE(warns_of(*loaded, "left.R"));
}

TEST(ReadExr, WhatCannotBeReadIsRefused) {
    const Image image = test_image(16, 8);
    EXPECT_NE(message_of(read(make_deep_exr())).find("deep"), std::string::npos);
    EXPECT_NE(message_of(read(make_exr(image, {.channels = {"R", "G"}}))).find("no part"), std::string::npos);
    EXPECT_NE(message_of(read(make_exr(image), {.most_pixels = 127})).find("at most 127"), std::string::npos);
}

TEST(ReadExr, TruncatedAtEveryByteIsAnError) {
    const Image image = test_image(16, 8);
    std::vector<std::string> files{make_luminance_chroma_exr(image),
                                   make_multi_part_exr(image, {{"Z"}, {"R", "G", "B"}})};
    for (const Imf::Compression c :
         {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION})
        for (const Layout layout : {Layout::scan_lines, Layout::tiles})
            files.push_back(make_exr(image, {.layout = layout, .compression = c}));
    for (const std::string& whole : files) {
        ASSERT_TRUE(read(whole));
        for (std::size_t length = 0; length < whole.size(); ++length) {
            const auto loaded = read(whole.substr(0, length));
            ASSERT_FALSE(loaded) << length << " of " << whole.size();
            EXPECT_EQ(message_of(loaded).rfind("picture.exr: ", 0), 0u);
        }
    }
}

/// The file with `value` stored `offset` bytes into the attribute `name`.
std::string patched(std::string bytes, const std::string& name_and_type, std::size_t offset, std::int32_t value) {
    const std::size_t begin = bytes.find(name_and_type);
    EXPECT_NE(begin, std::string::npos);
    std::memcpy(bytes.data() + begin + name_and_type.size() + offset, &value, sizeof value);
    return bytes;
}

TEST(ReadExr, HostileHeadersAreRefused) {
    using namespace std::string_literals;
    const std::string good = make_exr(test_image(16, 8), {.layout = Layout::tiles});
    const std::string window = "dataWindow\0box2i\0"s, tiles = "tiles\0tiledesc\0"s, channels = "channels\0chlist\0"s;
    // A size precedes the value: the window's right edge is at 4 + 8.
    for (const std::int32_t edge : {-1, 99999, 1 << 26, std::numeric_limits<std::int32_t>::max()}) {
        EXPECT_FALSE(read(patched(good, window, 12, edge))) << edge;
        EXPECT_FALSE(read(patched(good, window, 16, edge))) << edge;
    }
    for (const std::int32_t size : {0, -1, 1 << 30}) {
        EXPECT_FALSE(read(patched(good, tiles, 4, size))) << size;
        EXPECT_FALSE(read(patched(good, tiles, 8, size))) << size;
    }
    for (const std::int32_t size : {0, 5, -1, 1 << 30}) EXPECT_FALSE(read(patched(good, window, 0, size))) << size;
    // Sampling of channel B, after its name, type and padding; and an allowed size that the bytes cannot hold.
    for (const std::int32_t rate : {0, -1, 2}) EXPECT_FALSE(read(patched(good, channels, 4 + 2 + 8, rate))) << rate;
    const auto large = read(patched(patched(good, window, 12, 16383), window, 16, 16383));
    EXPECT_FALSE(large);
}

TEST(ReadExr, FileAndMemoryAgree) {
    const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "agree.exr";
    const Image image = test_image(40, 20);
    ASSERT_TRUE(write_exr(path, image));
    const auto loaded = read_environment(path);
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_EQ(loaded->image.pixels, image.pixels);
}

TEST(ReadExr, WhatIsNoRadianceIsCounted) {
    Image image = test_image(16, 8);
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    image.at(3, 1) = {nan, -1, inf};
    image.at(5, 6) = {1, inf, 2};
    image.at(6, 6) = {1, 2, -3};
    const Result<std::string> bytes = encode_exr(image);
    ASSERT_TRUE(bytes);

    const std::string message = message_of(read(*bytes));
    EXPECT_NE(message.find("1 NaN, 1 infinite (or above 1e15) and 1 negative"), std::string::npos) << message;
    EXPECT_NE(message.find("x = 3, y = 1"), std::string::npos) << message;
    EXPECT_NE(message.find("--sanitize"), std::string::npos) << message;

    const auto loaded = read(*bytes, {.sanitize = true});
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->sanitized.total(), 3u);
    EXPECT_EQ(loaded->image.at(3, 1), (Rgb{0, 0, 0}));
    EXPECT_EQ(loaded->image.at(5, 6), (Rgb{1, 0, 2}));
    EXPECT_EQ(loaded->image.at(6, 6), (Rgb{1, 2, 0}));
}

}  // namespace
}  // namespace lobelia
