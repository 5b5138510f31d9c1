// Tests OpenEXR: every compression, pixel type and layout decodes to the same image, and a damaged file never gives a
// partial one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "image_reading.h"
#include "io/read_image.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "io_files.h"
#include "lobelia/environment.h"

namespace lobelia {
namespace {

using test::message_of;
using test::warns_of;

using Layout = ExrSpec::Layout;

Result<LoadedImage> read_exr_bytes(const std::string& bytes, const ReadOptions& options = {}) {
    return read_exr(std::as_bytes(std::span(bytes)), "picture.exr", options);
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
                const auto loaded =
                    read_exr_bytes(make_exr(image, {.layout = layout, .compression = compression, .type = type}));
                ASSERT_TRUE(loaded) << message_of(loaded);
                // Whole numbers survive all lossless schemes; the lossy ones keep about 5 bits of this noise.
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
        const auto loaded = read_exr_bytes(make_exr(image, {.compression = compression}));
        EXPECT_TRUE(loaded) << message_of(loaded);
    }
}

TEST(ReadExr, DataWindowsAnywhere) {
    const Image image = test_image(20, 10);
    for (const int left : {-1000, -7, 0, 3, 100000}) {
        for (const Layout layout : {Layout::scan_lines, Layout::tiles}) {
            const auto loaded = read_exr_bytes(make_exr(image, {.layout = layout, .left = left, .top = -2 * left}));
            ASSERT_TRUE(loaded) << message_of(loaded);
            EXPECT_EQ(loaded->image.pixels, image.pixels) << left;
        }
    }
}

TEST(ReadExr, TheImageIsTheDisplayWindow) {
    const Image image = test_image(20, 10);
    struct Window {
        int left, top, right, bottom;
        const char* warning;
    };
    // Larger, smaller, both at once, and the same.
    for (const Window& w : {Window{-5, -3, 34, 16, "are black"}, Window{4, 2, 13, 6, "outside the display window"},
                            Window{-5, 4, 9, 13, "are black"}, Window{0, 0, 19, 9, ""}}) {
        for (const Layout layout : {Layout::scan_lines, Layout::tiles})
            for (const std::vector<std::string>& channels : {std::vector<std::string>{"R", "G", "B"}, {"Y"}}) {
                const auto loaded =
                    read_exr_bytes(make_exr(image, {.layout = layout,
                                                    .channels = channels,
                                                    .left = 0,
                                                    .display = std::array{w.left, w.top, w.right, w.bottom}}));
                ASSERT_TRUE(loaded) << message_of(loaded);
                ASSERT_EQ(loaded->image.width, static_cast<std::size_t>(w.right - w.left + 1));
                ASSERT_EQ(loaded->image.height, static_cast<std::size_t>(w.bottom - w.top + 1));
                EXPECT_EQ(warns_of(*loaded, "display window"), *w.warning != 0);
                EXPECT_TRUE(warns_of(*loaded, w.warning) || *w.warning == 0);
                for (int y = w.top; y <= w.bottom; ++y)
                    for (int x = w.left; x <= w.right; ++x) {
                        const bool stored = x >= 0 && y >= 0 && x < 20 && y < 10;
                        const Rgb pixel =
                            stored ? image.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y)) : Rgb{};
                        const Rgb expected = channels.size() == 1 ? Rgb{pixel.r, pixel.r, pixel.r} : pixel;
                        ASSERT_EQ(
                            loaded->image.at(static_cast<std::size_t>(x - w.left), static_cast<std::size_t>(y - w.top)),
                            expected)
                            << x << " " << y;
                    }
            }
    }
}

TEST(ReadExr, WindowsThatDoNotOverlapAreRefused) {
    const auto loaded = read_exr_bytes(make_exr(test_image(16, 8), {.left = 16, .display = std::array{0, 0, 15, 7}}));
    EXPECT_NE(message_of(loaded).find("outside the display window"), std::string::npos) << message_of(loaded);
    // A display window beyond the limits would be allocated.
    const ReadOptions small{.most_pixels = 1 << 10};
    EXPECT_FALSE(read_exr_bytes(make_exr(test_image(16, 8), {.display = std::array{0, 0, 63, 63}}), small));
}

/// Radiance that changes slowly with the direction, differently along the axes.
Rgb smooth_radiance(Vec3 d) { return {2 + d.x, 2 + d.y, 2 + d.z}; }
Rgb smooth_radiance(const Imath::V3f& d) {
    const Imath::V3f unit = d.normalized();
    return smooth_radiance(Vec3{unit.x, unit.y, unit.z});
}

/// Environments whose pixels have the directions that OpenEXR's own functions give them.
Image openexr_latitude_longitude(std::size_t width, std::size_t height) {
    Image image(width, height);
    const Imath::Box2i window({0, 0}, {static_cast<int>(width) - 1, static_cast<int>(height) - 1});
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            image.at(x, y) = smooth_radiance(
                Imf::LatLongMap::direction(window, Imath::V2f(static_cast<float>(x), static_cast<float>(y))));
    return image;
}
Image openexr_cube(std::size_t side) {
    Image image(side, 6 * side);
    const Imath::Box2i window({0, 0}, {static_cast<int>(side) - 1, static_cast<int>(6 * side) - 1});
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto face = static_cast<Imf::CubeMapFace>(i / (side * side));
        const Imath::V2f in_face(static_cast<float>(i % side), static_cast<float>(i / side % side));
        const Imath::V2f place = Imf::CubeMap::pixelPosition(face, window, in_face);
        image.at(static_cast<std::size_t>(std::lround(place.x)), static_cast<std::size_t>(std::lround(place.y))) =
            smooth_radiance(Imf::CubeMap::direction(face, window, in_face));
    }
    return image;
}

TEST(ReadExr, EnvironmentsFollowTheirAttribute) {
    for (const Imf::Envmap layout : {Imf::ENVMAP_LATLONG, Imf::ENVMAP_CUBE}) {
        const Image image = layout == Imf::ENVMAP_CUBE ? openexr_cube(32) : openexr_latitude_longitude(128, 64);
        const auto loaded = read_exr_bytes(make_exr(image, {.type = Imf::FLOAT, .envmap = layout}));
        ASSERT_TRUE(loaded) << message_of(loaded);
        EXPECT_TRUE(warns_of(*loaded, layout == Imf::ENVMAP_CUBE ? "cube" : "turned by half"));
        EXPECT_FALSE(warns_of(*loaded, "2 : 1"));
        const LatLong grid = lat_long(loaded->image);
        ASSERT_EQ(grid, (LatLong{128, 64}));
        // Within a texel of the cube's face, or half a texel of the map: their centres differ by convention.
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const Rgb expected = smooth_radiance(grid.direction(i)), found = loaded->image.pixels[i];
            EXPECT_NEAR(found.r, expected.r, 0.06) << i;
            EXPECT_NEAR(found.g, expected.g, 0.06) << i;
            EXPECT_NEAR(found.b, expected.b, 0.06) << i;
        }
    }
}

TEST(ReadExr, ConstantCubeStaysConstant) {
    Image cube(16, 96);
    std::fill(cube.pixels.begin(), cube.pixels.end(), Rgb{1, 2, 4});
    const auto loaded = read_exr_bytes(make_exr(cube, {.envmap = Imf::ENVMAP_CUBE}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    for (const Rgb& pixel : loaded->image.pixels) {
        ASSERT_NEAR(pixel.r, 1, 1e-5);
        ASSERT_NEAR(pixel.b, 4, 4e-5);
    }
}

TEST(ReadExr, OneFaceOfACubeIsASixthOfTheSphere) {
    for (std::size_t face = 0; face < 6; ++face) {
        Image cube(32, 192);
        std::fill_n(cube.pixels.begin() + static_cast<std::ptrdiff_t>(face * 1024), 1024, Rgb{1, 1, 1});
        const auto loaded = read_exr_bytes(make_exr(cube, {.envmap = Imf::ENVMAP_CUBE}));
        ASSERT_TRUE(loaded) << message_of(loaded);
        const LatLong grid = lat_long(loaded->image);
        double sum = 0;
        for (std::size_t i = 0; i < grid.size(); ++i)
            sum += static_cast<double>(loaded->image.pixels[i].r) * grid.solid_angle(i / grid.width);
        EXPECT_NEAR(sum, 4 * k_pi / 6, 2e-3) << face;
        // The faces are those of +x, -x, +y, -y, +z, -z.
        const float sign = face % 2 == 0 ? 1 : -1;
        const Vec3 axis{face / 2 == 0 ? sign : 0, face / 2 == 1 ? sign : 0, face / 2 == 2 ? sign : 0};
        EXPECT_NEAR(loaded->image.pixels[grid.index(axis)].r, 1, 1e-5) << face;
    }
}

TEST(ReadExr, CubesOfOtherShapesAreRefused) {
    const auto loaded = read_exr_bytes(make_exr(test_image(20, 10), {.envmap = Imf::ENVMAP_CUBE}));
    EXPECT_NE(message_of(loaded).find("envmap"), std::string::npos) << message_of(loaded);
    EXPECT_FALSE(read_exr_bytes(make_exr(test_image(16, 96), {.envmap = Imf::ENVMAP_CUBE}), {.most_pixels = 2047}));
    EXPECT_FALSE(read_exr_bytes(make_exr(test_image(20, 10), {.envmap = static_cast<Imf::Envmap>(7)})));
}

TEST(ReadExr, LuminanceIsGrey) {
    const Image image = test_image(16, 8);
    const auto loaded = read_exr_bytes(make_exr(image, {.channels = {"Y"}}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_EQ(loaded->image.pixels[i], (Rgb{image.pixels[i].r, image.pixels[i].r, image.pixels[i].r}));
}

TEST(ReadExr, LuminanceAndChroma) {
    // Chroma is stored at half rate: a plain colour comes back.
    Image image(16, 8);
    std::fill(image.pixels.begin(), image.pixels.end(), Rgb{4, 2, 1});
    const auto loaded = read_exr_bytes(make_luminance_chroma_exr(image));
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_LE(largest_difference(loaded->image, image), 0.02);
}

TEST(ReadExr, FirstPartWithColourIsRead) {
    const Image image = test_image(16, 8);
    const auto parts = read_exr_bytes(make_multi_part_exr(image, {{"Z"}, {"R", "G", "B", "A"}, {"Y"}}));
    ASSERT_TRUE(parts) << message_of(parts);
    EXPECT_EQ(parts->image.pixels, image.pixels);
    EXPECT_TRUE(warns_of(*parts, "read part 1 (\"part 1\") of 3"));
    // Layers count only where no part has plain channels.
    const auto layered = read_exr_bytes(make_multi_part_exr(image, {{"left.R", "left.G", "left.B"}, {"Y"}}));
    ASSERT_TRUE(layered) << message_of(layered);
    EXPECT_TRUE(warns_of(*layered, "read part 1"));
}

TEST(ReadExr, LayersAreTheFallback) {
    const Image image = test_image(16, 8);
    const auto loaded = read_exr_bytes(make_exr(image, {.channels = {"left.R", "left.G", "left.B"}}));
    ASSERT_TRUE(loaded) << message_of(loaded);
    EXPECT_EQ(loaded->image.pixels, image.pixels);
    EXPECT_TRUE(warns_of(*loaded, "left.R"));
}

TEST(ReadExr, UnsupportedFilesAreRefused) {
    const Image image = test_image(16, 8);
    EXPECT_NE(message_of(read_exr_bytes(make_deep_exr())).find("deep"), std::string::npos);
    EXPECT_NE(message_of(read_exr_bytes(make_exr(image, {.channels = {"R", "G"}}))).find("no part"), std::string::npos);
    EXPECT_NE(message_of(read_exr_bytes(make_exr(image), {.most_pixels = 127})).find("at most 127"), std::string::npos);
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
        ASSERT_TRUE(read_exr_bytes(whole));
        for (std::size_t length = 0; length < whole.size(); ++length) {
            const auto loaded = read_exr_bytes(whole.substr(0, length));
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
        EXPECT_FALSE(read_exr_bytes(patched(good, window, 12, edge))) << edge;
        EXPECT_FALSE(read_exr_bytes(patched(good, window, 16, edge))) << edge;
    }
    const std::string display = "displayWindow\0box2i\0"s;
    for (const std::int32_t edge : {-1, 99999, 1 << 26, std::numeric_limits<std::int32_t>::max()}) {
        EXPECT_FALSE(read_exr_bytes(patched(good, display, 12, edge))) << edge;
        EXPECT_FALSE(read_exr_bytes(patched(good, display, 16, edge))) << edge;
    }
    for (const std::int32_t size : {0, -1, 1 << 30}) {
        EXPECT_FALSE(read_exr_bytes(patched(good, tiles, 4, size))) << size;
        EXPECT_FALSE(read_exr_bytes(patched(good, tiles, 8, size))) << size;
    }
    for (const std::int32_t size : {0, 5, -1, 1 << 30})
        EXPECT_FALSE(read_exr_bytes(patched(good, window, 0, size))) << size;
    // Sampling of channel B, after its name, type and padding; and an allowed size that the bytes cannot hold.
    for (const std::int32_t rate : {0, -1, 2})
        EXPECT_FALSE(read_exr_bytes(patched(good, channels, 4 + 2 + 8, rate))) << rate;
    const auto large = read_exr_bytes(patched(patched(good, window, 12, 16383), window, 16, 16383));
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

TEST(ReadExr, InvalidRadianceIsCounted) {
    Image image = test_image(16, 8);
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    image.at(3, 1) = {nan, -1, inf};
    image.at(5, 6) = {1, inf, 2};
    image.at(6, 6) = {1, 2, -3};
    const Result<std::string> bytes = encode_exr(image);
    ASSERT_TRUE(bytes);

    const std::string message = message_of(read_exr_bytes(*bytes));
    EXPECT_NE(message.find("1 NaN, 1 infinite (or above 1e15) and 1 negative"), std::string::npos) << message;
    EXPECT_NE(message.find("x = 3, y = 1"), std::string::npos) << message;
    EXPECT_NE(message.find("--sanitize"), std::string::npos) << message;

    const auto loaded = read_exr_bytes(*bytes, {.sanitize = true});
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->sanitized.total(), 3u);
    EXPECT_EQ(loaded->image.at(3, 1), (Rgb{0, 0, 0}));
    EXPECT_EQ(loaded->image.at(5, 6), (Rgb{1, 0, 2}));
    EXPECT_EQ(loaded->image.at(6, 6), (Rgb{1, 2, 0}));
}

}  // namespace
}  // namespace lobelia
