// Tests named channels of OpenEXR: streaming and in-memory encoding give the same bytes, every channel reads back, and
// damaged files are refused before memory is allocated for them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "folders.h"
#include "io/read_exr_channels.h"
#include "io/write_image.h"
#include "io_files.h"

namespace lobelia {
namespace {

using Layout = ExrSpec::Layout;

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string planes_error(const std::string& bytes, const ReadChannelsOptions& options = {}) {
    const auto read = read_exr_channels(bytes_of(bytes), "planes.exr", options);
    return read ? "" : read.error().message;
}

/// `count` planes of random floats over many orders of magnitude, and their names.
struct ChannelPlanes {
    ChannelPlanes(std::size_t w, std::size_t h, std::size_t count) : width(w), height(h) {
        std::mt19937 generator(3);
        std::uniform_real_distribution<float> uniform(-12, 12);
        for (std::size_t i = 0; i < count; ++i) {
            names.push_back("c" + std::to_string(i) + ".R");
            auto& plane = planes.emplace_back(w * h);
            for (float& v : plane) v = std::pow(10.0f, uniform(generator)) * (uniform(generator) < 0 ? -1.0f : 1.0f);
        }
    }
    [[nodiscard]] std::vector<ExrChannel> channels() const {
        std::vector<ExrChannel> result;
        for (std::size_t i = 0; i < names.size(); ++i) result.push_back({names[i], planes[i]});
        return result;
    }
    std::size_t width, height;
    std::vector<std::string> names;
    std::vector<std::vector<float>> planes;
};

std::string encoded(const ChannelPlanes& p, const ExrOptions& options = {}) {
    return encode_exr(p.width, p.height, p.channels(), options).value();
}

std::string staged(const std::filesystem::path& path, const ChannelPlanes& p, const std::vector<ExrChannel>& channels,
                   const ExrOptions& options) {
    auto file = StagedFile::create(path).value();
    EXPECT_TRUE(write_exr(file, p.width, p.height, channels, options));
    EXPECT_TRUE(file.commit());
    return test::contents(path);
}

TEST(ExrChannels, StreamedEqualsEncodedInMemory) {
    const test::TestFolder folder("exr-channels");
    // Half floats are converted in bands of rows; 2^21 values make one band.
    ChannelPlanes planes(257, 391, 23);
    for (auto& plane : planes.planes) std::fill(plane.begin() + 99, plane.end() - 99, plane[50]);
    for (const auto precision : {ExrOptions::Precision::half, ExrOptions::Precision::full})
        EXPECT_EQ(staged(folder.path() / "a.exr", planes, planes.channels(), {precision}),
                  encoded(planes, {precision}));
}

TEST(ExrChannels, RoundTripInTheOrderAskedFor) {
    // More channels than the pictures' reader takes; the file sorts c10 before c2.
    const ChannelPlanes planes(7, 40, 300);
    const std::string bytes = encoded(planes);
    ReadChannelsOptions options;
    options.wanted = planes.names;
    const auto read = read_exr_channels(bytes_of(bytes), "planes.exr", options);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->width, 7u);
    EXPECT_EQ(read->height, 40u);
    EXPECT_EQ(read->names, planes.names);
    EXPECT_EQ(read->planes, planes.planes);

    const auto all = read_exr_channels(bytes_of(bytes), "planes.exr");
    ASSERT_TRUE(all);
    EXPECT_EQ(all->names.size(), 300u);
    EXPECT_TRUE(std::is_sorted(all->names.begin(), all->names.end()));
    for (std::size_t i = 0; i < 300; ++i)
        EXPECT_EQ(all->planes[i], planes.planes[static_cast<std::size_t>(std::stoi(all->names[i].substr(1)))]);
}

TEST(ExrChannels, EachChannelMayHaveItsPrecision) {
    const test::TestFolder folder("exr-precision");
    ChannelPlanes planes(5, 50, 3);
    for (float& v : planes.planes[1]) v = std::clamp(v, -1e4f, 1e4f);
    auto channels = planes.channels();
    channels[1].precision = ExrOptions::Precision::half;
    const std::string bytes = staged(folder.path() / "a.exr", planes, channels, {});
    const auto read = read_exr_channels(folder.path() / "a.exr");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->planes[0], planes.planes[0]);
    EXPECT_EQ(read->planes[2], planes.planes[2]);
    for (std::size_t i = 0; i < 250; ++i) {
        const float value = planes.planes[1][i];
        EXPECT_NEAR(read->planes[1][i], value, std::abs(value) / 2048 + 3.1e-8f);
    }
}

TEST(ExrChannels, EveryLayoutAndTypeIsRead) {
    const Image image = test_image(40, 20);
    for (const auto type : {Imf::HALF, Imf::FLOAT, Imf::UINT})
        for (const Layout layout : {Layout::scan_lines, Layout::tiles, Layout::mipmap, Layout::ripmap}) {
            const std::string bytes =
                make_exr(image, {.layout = layout, .type = type, .channels = {"x", "y", "z"}, .left = -7});
            const auto read = read_exr_channels(bytes_of(bytes), "planes.exr");
            ASSERT_TRUE(read) << read.error().message;
            for (std::size_t i = 0; i < image.pixels.size(); ++i)
                EXPECT_EQ((Rgb{read->planes[0][i], read->planes[1][i], read->planes[2][i]}), image.pixels[i]);
        }
}

TEST(ExrChannels, PlanesCoverTheDisplayWindow) {
    const Image image = test_image(20, 10);
    const std::string bytes =
        make_exr(image, {.channels = {"x", "y", "z"}, .left = 3, .top = 2, .display = std::array{0, 0, 24, 9}});
    const auto read = read_exr_channels(bytes_of(bytes), "planes.exr");
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->width, 25u);
    ASSERT_EQ(read->height, 10u);
    for (std::size_t y = 0; y < 10; ++y)
        for (std::size_t x = 0; x < 25; ++x) {
            const bool stored = x >= 3 && x < 23 && y >= 2;
            const Rgb expected = stored ? image.at(x - 3, y - 2) : Rgb{};
            EXPECT_EQ((Rgb{read->planes[0][y * 25 + x], read->planes[1][y * 25 + x], read->planes[2][y * 25 + x]}),
                      expected);
        }
}

TEST(ExrChannels, TruncatedAtEveryByteIsAnError) {
    const std::string whole = encoded(ChannelPlanes(9, 20, 3));
    ASSERT_EQ(planes_error(whole), "");
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_EQ(planes_error(whole.substr(0, length)).rfind("planes.exr: ", 0), 0u) << length;
}

TEST(ExrChannels, UnsupportedFilesAreRefused) {
    const std::string bytes = encoded(ChannelPlanes(16, 8, 5));
    EXPECT_NE(planes_error(bytes, {.wanted = {"c1.R", "c9.R"}}).find("no channel c9.R"), std::string::npos);
    EXPECT_NE(planes_error(bytes, {.most_pixels = 127}).find("at most 127"), std::string::npos);
    EXPECT_NE(planes_error(bytes, {.most_channels = 4}).find("more than 4 channels"), std::string::npos);
    EXPECT_NE(planes_error(bytes, {.most_values = 639}).find("more than 639 values"), std::string::npos);
    EXPECT_EQ(planes_error(bytes, {.most_values = 640}), "");
    EXPECT_NE(planes_error(make_deep_exr()).find("deep"), std::string::npos);
    EXPECT_NE(planes_error(make_luminance_chroma_exr(test_image(16, 8))).find("sampled at 1/2"), std::string::npos);
    EXPECT_NE(planes_error("no image").find("planes.exr: "), std::string::npos);
    for (const char* path : {"/dev/zero", "/no/such/file.exr", "/"}) {
        const auto read = read_exr_channels(std::filesystem::path(path));
        ASSERT_FALSE(read);
        EXPECT_EQ(read.error().message.rfind(path, 0), 0u) << read.error().message;
    }
}

TEST(ExrChannels, AnyByteChangedIsAnErrorOrAnImage) {
    const std::string good = encoded(ChannelPlanes(9, 20, 3));
    const ReadChannelsOptions small{.most_pixels = 1 << 16, .most_values = 1 << 18};
    std::mt19937 generator(8);
    for (int i = 0; i < 4000; ++i) {
        std::string bytes = good;
        for (int k = 0; k < 3; ++k) bytes[generator() % bytes.size()] = static_cast<char>(generator());
        const auto read = read_exr_channels(bytes_of(bytes), "planes.exr", small);
        if (!read) continue;
        for (const auto& plane : read->planes) ASSERT_EQ(plane.size(), read->width * read->height);
    }
}

TEST(ExrChannels, FullDiskLeavesTheOldFile) {
    const test::TestFolder folder("exr-full");
    const auto path = folder.path() / "a.exr";
    test::overwrite(path, "old");
    // Truncate at the beginning, in the middle, and where only the table of chunks does not fit.
    const ChannelPlanes planes(64, 64, 4);
    const std::size_t size = encoded(planes).size();
    for (const std::size_t most : {std::size_t{10}, size / 2, size - 4}) {
        const Status status = [&]() -> Status {
            const test::FileSizeLimit limit(most);
            auto file = StagedFile::create(path).value();
            return write_exr(file, planes.width, planes.height, planes.channels());
        }();
        ASSERT_FALSE(status) << most;
        EXPECT_NE(status.error().message.find("a.exr: cannot be written"), std::string::npos);
        EXPECT_EQ(test::contents(path), "old");
        EXPECT_EQ(folder.entries(), 1u);
    }
}

}  // namespace
}  // namespace lobelia
