// Tests PNG, JPEG and WebP: every kind decodes to the same picture, and damaged files never give a partial one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "io/read_image.h"
#include "io/read_picture.h"
#include "io/write_image.h"
#include "io_files.h"
#include "picture_files.h"

namespace lobelia {
namespace {

using namespace std::string_literals;
using JpegColours = JpegSpec::Colours;
using Scans = JpegSpec::Scans;

constexpr std::size_t k_picture_width = 19, k_picture_height = 10, k_most_pixels = 1 << 16;

Result<PictureRgba8> read_rgba8(const std::string& bytes, std::size_t most_pixels = k_most_pixels) {
    return read_picture_rgba8(std::as_bytes(std::span(bytes)), "picture", most_pixels);
}

std::string picture_error(const std::string& bytes, std::size_t most_pixels = k_most_pixels) {
    const auto picture = read_rgba8(bytes, most_pixels);
    return picture ? "" : picture.error().message;
}

Result<LoadedImage> read_as_environment(const std::string& bytes) {
    return read_environment(std::as_bytes(std::span(bytes)), "picture", {.ldr = true, .most_pixels = k_most_pixels});
}

/// Returns the largest difference of a sample; 256 if the sizes differ.
int largest_difference(const PictureRgba8& a, const TestPicture& b) {
    if (a.width != b.width || a.height != b.height || a.texels.size() != b.texels.size()) return 256;
    int largest = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a.texels[i][c] - b.texels[i][c]));
    return largest;
}

TestPicture grey(TestPicture picture) {
    for (auto& t : picture.texels)
        t[0] = t[1] = t[2] = static_cast<std::uint8_t>(std::lround(0.299 * t[0] + 0.587 * t[1] + 0.114 * t[2]));
    return picture;
}

std::vector<PngSpec> png_kinds() {
    using Png = PngSpec::Colours;
    std::vector<PngSpec> kinds;
    for (const bool interlaced : {false, true})
        for (const bool transparent : {false, true}) {
            for (const int bits : {1, 2, 4, 8, 16}) kinds.push_back({Png::grey, bits, interlaced, transparent});
            for (const int bits : {1, 2, 4, 8}) kinds.push_back({Png::palette, bits, interlaced, transparent});
            for (const int bits : {8, 16}) kinds.push_back({Png::rgb, bits, interlaced, transparent});
            for (const Png colours : {Png::grey_alpha, Png::rgba})
                for (const int bits : {8, 16}) kinds.push_back({colours, bits, interlaced, false});
        }
    return kinds;
}

std::vector<JpegSpec> jpeg_kinds() {
    std::vector<JpegSpec> kinds;
    for (const JpegColours colours :
         {JpegColours::grey, JpegColours::ycc, JpegColours::rgb, JpegColours::cmyk, JpegColours::ycck})
        for (const Scans scans : {Scans::interleaved, Scans::by_component, Scans::progressive}) {
            kinds.push_back({.colours = colours, .scans = scans});
            kinds.push_back({.colours = colours, .scans = scans, .restart_interval = 2});
        }
    kinds.push_back({.colours = JpegColours::cmyk, .adobe = false});
    return kinds;
}

/// Returns a file of each format.
std::vector<std::string> some_files() {
    const TestPicture picture = test_picture(k_picture_width, k_picture_height, Alpha::transparent);
    return {make_png(k_picture_width, k_picture_height).bytes,
            make_png(k_picture_width, k_picture_height, {PngSpec::Colours::palette, 4, true, true}).bytes,
            make_jpeg(picture),
            make_jpeg(picture, {.scans = Scans::progressive}),
            make_jpeg(picture, {.colours = JpegColours::ycck, .scans = Scans::by_component}),
            make_webp(picture),
            make_webp(picture, {.lossless = false})};
}

TEST(ReadPicture, EveryKindOfPngDecodes) {
    for (const PngSpec& spec : png_kinds()) {
        const PngFile file = make_png(k_picture_width, k_picture_height, spec);
        const auto picture = read_rgba8(file.bytes);
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_EQ(largest_difference(*picture, file.picture), 0)
            << static_cast<int>(spec.colours) << " bits " << spec.bits << " transparent " << spec.transparent;
    }
}

TEST(ReadPicture, EveryKindOfJpegDecodes) {
    const TestPicture colours = test_picture(k_picture_width, k_picture_height);
    for (const JpegSpec& spec : jpeg_kinds()) {
        const auto picture = read_rgba8(make_jpeg(colours, spec));
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_LE(largest_difference(*picture, spec.colours == JpegColours::grey ? grey(colours) : colours), 12)
            << static_cast<int>(spec.colours) << " scans " << static_cast<int>(spec.scans);
    }
}

TEST(ReadPicture, EveryKindOfWebpDecodes) {
    const TestPicture colours = test_picture(k_picture_width, k_picture_height, Alpha::transparent);
    const auto lossless = read_rgba8(make_webp(colours)), lossy = read_rgba8(make_webp(colours, {.lossless = false}));
    ASSERT_TRUE(lossless) << lossless.error().message;
    ASSERT_TRUE(lossy) << lossy.error().message;
    EXPECT_EQ(largest_difference(*lossless, colours), 0);
    EXPECT_LE(largest_difference(*lossy, colours), 60);
    EXPECT_NE(picture_error(make_animated_webp()).find("animated"), std::string::npos)
        << picture_error(make_animated_webp());
}

TEST(ReadPicture, TruncatedAtEveryByteIsAnError) {
    for (const std::string& whole : some_files()) {
        ASSERT_EQ(picture_error(whole), "");
        for (std::size_t length = 0; length < whole.size(); ++length)
            EXPECT_EQ(picture_error(whole.substr(0, length)).rfind("picture: ", 0), 0u)
                << length << " of " << whole.size() << " bytes of " << whole.substr(1, 3);
    }
}

TEST(ReadPicture, BytesAfterTheEndAreIgnored) {
    for (const std::string& whole : some_files()) EXPECT_EQ(picture_error(whole + std::string(99, 'x')), "");
}

TEST(ReadPicture, AnyByteChangedIsAnErrorOrAPicture) {
    std::mt19937 generator(5);
    for (const std::string& good : some_files())
        for (int i = 0; i < 1000; ++i) {
            std::string bytes = good;
            for (int k = 0; k < 3; ++k) bytes[generator() % bytes.size()] = static_cast<char>(generator());
            const auto picture = read_rgba8(bytes);
            if (!picture) continue;
            ASSERT_EQ(picture->texels.size(), picture->width * picture->height);
        }
}

TEST(ReadPicture, JpegTablesMustBeDefined) {
    const TestPicture picture = test_picture(k_picture_width, k_picture_height);
    for (const Scans scans : {Scans::interleaved, Scans::by_component, Scans::progressive}) {
        const std::string good = make_jpeg(picture, {.scans = scans});
        const std::string huffman = picture_error(jpeg_without(good, 0xc4)),
                          quantisation = picture_error(jpeg_without(good, 0xdb));
        EXPECT_NE(huffman.find("Huffman table"), std::string::npos) << huffman;
        EXPECT_NE(huffman.find("at byte"), std::string::npos) << huffman;
        EXPECT_NE(quantisation.find("uantization table"), std::string::npos) << quantisation;
    }
    // Use tables that a single scan names: of 0 to 3 all but the two defined ones, and numbers beyond the maximum.
    auto segments = split_jpeg(make_jpeg(picture, {.colours = JpegColours::grey}));
    auto scan = std::find_if(segments.begin(), segments.end(), [](const auto& s) { return s.code == 0xda; });
    ASSERT_NE(scan, segments.end());
    for (const char tables : {'\x01', '\x10', '\x11', '\x02', '\x20', '\x33', '\x04', '\x40', '\xff'}) {
        scan->bytes[6] = tables;
        EXPECT_NE(picture_error(join_jpeg(segments)).find("Huffman table"), std::string::npos)
            << static_cast<int>(tables);
    }
}

TEST(ReadPicture, LaterScansHaveNoDefaultTables) {
    // Use a scan for each component; all but the first name undefined tables.
    for (const std::size_t defined : {std::size_t{1}, std::size_t{2}}) {
        auto segments =
            split_jpeg(make_jpeg(test_picture(k_picture_width, k_picture_height), {.scans = Scans::by_component}));
        std::size_t scans = 0;
        for (auto& segment : segments)
            if (segment.code == 0xda && ++scans > defined) segment.bytes[6] = '\x22';
        EXPECT_NE(picture_error(join_jpeg(segments)).find("Huffman table"), std::string::npos) << defined;
    }
    auto segments =
        split_jpeg(make_jpeg(test_picture(k_picture_width, k_picture_height), {.scans = Scans::by_component}));
    std::size_t tables = 0;
    std::erase_if(segments, [&](const JpegSegment& s) { return s.code == 0xc4 && ++tables > 2; });
    EXPECT_FALSE(read_rgba8(join_jpeg(segments)));
}

TEST(ReadPicture, EveryComponentNeedsAScan) {
    for (const Scans kind : {Scans::by_component, Scans::progressive}) {
        auto segments = split_jpeg(make_jpeg(test_picture(k_picture_width, k_picture_height), {.scans = kind}));
        const auto count = [&] {
            return std::count_if(segments.begin(), segments.end(), [](const auto& s) { return s.code == 0xda; });
        };
        // Keep a single scan: the first one of a file by component, the last one of a progressive file.
        std::ptrdiff_t scans = 0;
        const std::ptrdiff_t all = count();
        std::erase_if(segments, [&](const JpegSegment& s) {
            if (s.code != 0xda) return false;
            ++scans;
            return kind == Scans::by_component ? scans > 1 : scans < all;
        });
        ASSERT_EQ(count(), 1);
        EXPECT_FALSE(read_rgba8(join_jpeg(segments)));
    }
}

TEST(ReadPicture, ManyScansAreRefused) {
    auto segments =
        split_jpeg(make_jpeg(test_picture(k_picture_width, k_picture_height), {.scans = Scans::by_component}));
    const auto scan = std::find_if(segments.begin(), segments.end(), [](const auto& s) { return s.code == 0xda; });
    ASSERT_NE(scan, segments.end());
    const JpegSegment copy = *scan;
    segments.insert(scan, 200, copy);
    EXPECT_NE(picture_error(join_jpeg(segments)).find("more than 100 scans"), std::string::npos);
}

TEST(ReadPicture, DamagedDataIsAnError) {
    // Flip bits everywhere in the image data of a PNG: the checksum detects them.
    const PngFile png = make_png(k_picture_width, k_picture_height);
    for (std::size_t i = png.bytes.find("IDAT") + 4; i < png.bytes.size(); ++i) {
        std::string damaged = png.bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ 4);
        EXPECT_FALSE(read_rgba8(damaged)) << i;
    }
    // Replace the end of the image data of a JPEG by zeros, which decode as the shortest code.
    const std::string jpeg = make_jpeg(test_picture(160, 160));
    std::string damaged = jpeg;
    std::fill(damaged.end() - 402, damaged.end() - 2, '\0');
    EXPECT_FALSE(read_rgba8(damaged));
}

TEST(ReadPicture, OrientationIsIgnored) {
    const TestPicture picture = test_picture(k_picture_width, k_picture_height);
    auto segments = split_jpeg(make_jpeg(picture));
    // Exif, little-endian, one entry: orientation, a short, 6 (rotated by 90 degrees).
    const std::string exif = "Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0"s;
    const auto size = static_cast<char>(exif.size() + 2);
    segments.insert(segments.begin() + 1, {0xe1, "\xff\xe1\0"s + size + exif});
    const auto turned = read_rgba8(join_jpeg(segments)), plain = read_rgba8(make_jpeg(picture));
    ASSERT_TRUE(turned) << turned.error().message;
    EXPECT_EQ(turned->texels, plain->texels);
    EXPECT_EQ(turned->width, k_picture_width);
}

TEST(ReadPicture, LimitsHoldBeforeAllocation) {
    for (const std::string& bytes : some_files())
        EXPECT_NE(picture_error(bytes, k_picture_width * k_picture_height - 1).find("at most 189 pixels"),
                  std::string::npos);
    // Claim 50000 x 50000 pixels in a few bytes: in the header of a PNG, and of a JPEG.
    std::string png = make_png(k_picture_width, k_picture_height).bytes;
    png.replace(16, 8, "\0\0\xc3\x50\0\0\xc3\x50"s);
    EXPECT_FALSE(read_rgba8(png, std::size_t{1} << 40));
    auto segments = split_jpeg(make_jpeg(test_picture(k_picture_width, k_picture_height)));
    for (auto& segment : segments)
        if (segment.code == 0xc0) segment.bytes.replace(5, 4, "\xc3\x50\xc3\x50");
    const std::string message = picture_error(join_jpeg(segments), std::size_t{1} << 40);
    EXPECT_NE(message.find("cannot hold 50000 x 50000"), std::string::npos) << message;
}

TEST(ReadPicture, UnreadFormatsAreNamed) {
    EXPECT_NE(picture_error("BM123456").find("a BMP picture is not supported; use PNG, JPEG or WebP"),
              std::string::npos);
    EXPECT_NE(picture_error("GIF89a").find("GIF"), std::string::npos);
    EXPECT_NE(picture_error("\xabKTX 20\xbb").find("KTX"), std::string::npos);
    EXPECT_NE(picture_error("text").find("neither PNG nor JPEG nor WebP"), std::string::npos);
    EXPECT_NE(picture_error("").find("empty"), std::string::npos);
    const auto bmp = read_as_environment("BM123456");
    ASSERT_FALSE(bmp);
    EXPECT_NE(bmp.error().message.find("a BMP picture is not supported"), std::string::npos) << bmp.error().message;
}

TEST(ReadLdr, SixteenBitsAreKept) {
    const PngFile file = make_png(k_picture_width, k_picture_height, {PngSpec::Colours::rgb, 16});
    const auto loaded = read_as_environment(file.bytes),
               coarse = read_as_environment(make_png(k_picture_width, k_picture_height).bytes);
    ASSERT_TRUE(loaded && coarse);
    std::vector<float> levels;
    for (const Rgb& pixel : loaded->image.pixels) levels.push_back(pixel.r);
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    // Among 190 random samples of 8 bits, more than a third would be equal to another.
    EXPECT_GT(levels.size(), 180u);
}

TEST(ReadLdr, PicturesNeedTheOption) {
    const auto png = encode_png(to_srgb(test_image(16, 8), 0.02f));
    ASSERT_TRUE(png);
    const auto bytes = std::as_bytes(std::span(*png));
    const auto loaded = read_environment(bytes, "picture.png");
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find("--ldr"), std::string::npos);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(read_environment(bytes.first(length), "picture.png", {.ldr = true})) << length;
}

TEST(ReadLdr, OversizedHuffmanTablesAreRefused) {
    // A table that claims 16 * 20 codes; at most 256 are possible.
    std::string jpeg("\xff\xd8\xff\xc4\x01\x53\x00", 7);
    jpeg.append(16, 20).append(320, 'c').append("\xff\xd9");
    const auto loaded = read_as_environment(jpeg);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find("Huffman"), std::string::npos) << loaded.error().message;
}

TEST(ReadLdr, ChunksLongerThanTheFileAreRefused) {
    const auto png = encode_png(to_srgb(test_image(16, 8), 0.02f));
    ASSERT_TRUE(png);
    // Set the length of the first chunk of image data to 1 GiB.
    std::string damaged = *png;
    const std::size_t at = damaged.find("IDAT") - 4;
    damaged.replace(at, 4, std::string("\x40\0\0\0", 4));
    const auto loaded = read_as_environment(damaged);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find("too large"), std::string::npos) << loaded.error().message;
}

}  // namespace
}  // namespace lobelia
