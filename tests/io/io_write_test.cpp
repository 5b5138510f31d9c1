// Tests that files are written completely or not at all, and that readers return what writers stored.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "folders.h"
#include "io/folders.h"
#include "io/read_image.h"
#include "io/staged_file.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "io_files.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

using test::contents;

/// An empty folder of one test.
class WriteFile : public ::testing::Test {
  protected:
    WriteFile() : holder_(::testing::UnitTest::GetInstance()->current_test_info()->name()), folder_(holder_.path()) {}
    [[nodiscard]] std::size_t entries() const { return holder_.entries(); }

    test::TestFolder holder_;
    fs::path folder_;
};

TEST_F(WriteFile, RoundTripLeavesNothingElse) {
    const std::string text("with\0zero", 9);
    ASSERT_TRUE(write_file_atomically(folder_ / "file", text));
    EXPECT_EQ(contents(folder_ / "file"), text);
    ASSERT_TRUE(write_file_atomically(folder_ / "file", std::string_view("shorter")));
    EXPECT_EQ(contents(folder_ / "file"), "shorter");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteFile, PermissionsOfTheOldFileAreKept) {
    ASSERT_TRUE(write_file_atomically(folder_ / "file", std::string_view("old")));
    ASSERT_EQ(::chmod((folder_ / "file").c_str(), 0640), 0);
    ASSERT_TRUE(write_file_atomically(folder_ / "file", std::string_view("new")));
    struct stat status {};
    ASSERT_EQ(::stat((folder_ / "file").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(WriteFile, FullDiskKeepsTheOldFile) {
    ASSERT_TRUE(write_file_atomically(folder_ / "file", std::string_view("old")));
    const Status status = [&] {
        const test::FileSizeLimit limit(1000);
        return write_file_atomically(folder_ / "file", std::string(5000, 'x'));
    }();
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("file: cannot be written"), std::string::npos) << status.error().message;
    EXPECT_EQ(contents(folder_ / "file"), "old");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteFile, FullDeviceIsAnError) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
    const Status status = write_file_atomically("/dev/full", std::string_view("text"));
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("No space left"), std::string::npos) << status.error().message;
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(WriteFile, PlacesThatCannotBeWritten) {
    ASSERT_TRUE(write_file_atomically(folder_ / "file", std::string_view("old")));
    const auto message = [](const fs::path& path) {
        const Status status = write_file_atomically(path, std::string_view("text"));
        return status ? std::string() : status.error().message;
    };
    EXPECT_NE(message(folder_).find("Is a directory"), std::string::npos);
    EXPECT_NE(message(folder_ / "missing" / "file").find("No such file"), std::string::npos);
    EXPECT_NE(message(folder_ / "file" / "file").find("Not a directory"), std::string::npos);
    EXPECT_NE(message("").find("missing"), std::string::npos);
    EXPECT_EQ(entries(), 1u);
}

TEST_F(WriteFile, UnwritableFolderIsAnError) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
    const Status status = write_file_atomically(folder_ / "file", std::string_view("text"));
    fs::permissions(folder_, fs::perms::owner_all);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("Permission denied"), std::string::npos) << status.error().message;
}

/// Whoever can put a link into a folder must not choose what is overwritten.
TEST_F(WriteFile, LinksAreReplacedNotFollowed) {
    test::overwrite(folder_ / "precious", "old");
    for (const char* to : {"precious", "nowhere", "link", "/dev/null"}) {
        fs::remove(folder_ / "link");
        fs::create_symlink(to, folder_ / "link");
        ASSERT_TRUE(write_file_atomically(folder_ / "link", std::string_view("text"))) << to;
        EXPECT_FALSE(fs::is_symlink(folder_ / "link")) << to;
        EXPECT_EQ(contents(folder_ / "link"), "text") << to;
    }
    EXPECT_EQ(contents(folder_ / "precious"), "old");
    EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
}

TEST_F(WriteFile, TheSystemsOwnLinksAreFollowed) {
    test::overwrite(folder_ / "file", "old");
    const int opened = ::open((folder_ / "file").c_str(), O_WRONLY);
    ASSERT_GE(opened, 0);
    ASSERT_TRUE(write_file_atomically("/proc/self/fd/" + std::to_string(opened), std::string_view("text")));
    ::close(opened);
    EXPECT_EQ(contents(folder_ / "file"), "text");

    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    ASSERT_TRUE(write_file_atomically("/proc/self/fd/" + std::to_string(ends[1]), std::string_view("text")));
    std::array<char, 8> text{};
    EXPECT_EQ(::read(ends[0], text.data(), text.size()), 4);
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_F(WriteFile, LinksInSharedMemoryAreAnybodys) {
    if (!fs::is_directory("/dev/shm") || ::access("/dev/shm", W_OK) != 0) GTEST_SKIP() << "no /dev/shm on this system";
    const fs::path link = "/dev/shm/lobelia-test-" + std::to_string(::getpid());
    test::overwrite(folder_ / "precious", "old");
    fs::create_symlink(fs::absolute(folder_ / "precious"), link);
    EXPECT_TRUE(write_file_atomically(link, std::string_view("text")));
    EXPECT_FALSE(fs::is_symlink(link));
    EXPECT_EQ(contents(link), "text");
    EXPECT_EQ(contents(folder_ / "precious"), "old");
    fs::remove(link);
}

TEST_F(WriteFile, AStopLeavesTheOldContent) {
    test::overwrite(folder_ / "file", "old");
    const std::atomic<bool> stop = true;
    auto staged = StagedFile::create(folder_ / "file", &stop);
    ASSERT_TRUE(staged);
    EXPECT_FALSE(staged->write(std::as_bytes(std::span("text", 4))));
    EXPECT_EQ(contents(folder_ / "file"), "old");
}

TEST_F(WriteFile, NothingThatIsNotFiniteIsWritten) {
    Image image(2, 1);
    image.pixels[1].g = INFINITY;
    const auto status = write_exr(folder_ / "image.exr", image);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("x = 1, y = 0"), std::string::npos) << status.error().message;
    EXPECT_FALSE(fs::exists(folder_ / "image.exr"));
}

TEST(WriteExr, HalfRoundsAndSaturates) {
    Image image(2, 1);
    image.pixels = {{0.1f, 1e6f, 65504}, {1, 2, 3}};
    const auto bytes = encode_exr(image, {.precision = ExrOptions::Precision::half});
    ASSERT_TRUE(bytes);
    const auto loaded = read_exr(std::as_bytes(std::span(*bytes)), "half.exr");
    ASSERT_TRUE(loaded);
    EXPECT_NEAR(loaded->image.pixels[0].r, 0.1, 0.1 / 2048);
    EXPECT_EQ(loaded->image.pixels[0].g, 65504);
    EXPECT_EQ(loaded->image.pixels[0].b, 65504);
    EXPECT_EQ(loaded->image.pixels[1], image.pixels[1]);
}

TEST(WriteExr, NamedChannelsWithStrides) {
    // Two interleaved pairs; the reader falls back to the layer that is whole.
    const std::vector<float> floats{1, 10, 2, 20};
    const std::span<const float> all(floats);
    const std::vector<ExrChannel> channels{
        {"sh.R", all, 2}, {"sh.G", all.subspan(1), 2}, {"sh.B", all.first(2), 1}, {"other", all.last(2), 1}};
    const auto bytes = encode_exr(2, 1, channels);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto loaded = read_exr(std::as_bytes(std::span(*bytes)), "channels.exr");
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->image.pixels, (std::vector<Rgb>{{1, 10, 1}, {2, 20, 10}}));
}

TEST(WriteExr, InvalidChannelsAreRefused) {
    const std::vector<float> floats(8);
    using Channels = std::vector<ExrChannel>;
    EXPECT_FALSE(encode_exr(2, 2, Channels{}));
    EXPECT_FALSE(encode_exr(0, 2, Channels{{"A", floats, 1}}));
    EXPECT_FALSE(encode_exr(2, 2, Channels{{"", floats, 1}}));
    EXPECT_FALSE(encode_exr(2, 2, Channels{{"A", floats, 1}, {"A", floats, 1}}));
    EXPECT_FALSE(encode_exr(4, 2, Channels{{"A", floats, 2}}));
    EXPECT_FALSE(encode_exr(Image()));
}

TEST(Folders, FailureLeavesNoFolder) {
    const test::TestFolder folder("output");
    const fs::path inner = folder.path() / "a" / "b" / "c";
    const std::vector<FileContent> files{{inner / "first", "1"}, {inner / "missing" / "second", "2"}};
    ASSERT_FALSE(write_into_folder(inner, files));
    EXPECT_EQ(folder.entries(), 0u);
    // A folder that was there, or that holds something, stays.
    fs::create_directory(folder.path() / "a");
    ASSERT_FALSE(write_into_folder(inner, files));
    EXPECT_TRUE(fs::is_directory(folder.path() / "a"));
    EXPECT_FALSE(fs::exists(folder.path() / "a" / "b"));
    {
        const auto made = MadeFolder::make(inner);
        ASSERT_TRUE(made) << made.error().message;
        test::overwrite(folder.path() / "a" / "b" / "other", "x");
    }
    EXPECT_FALSE(fs::exists(inner));
    EXPECT_TRUE(fs::exists(folder.path() / "a" / "b" / "other"));
}

TEST(Folders, SuccessKeepsTheFolders) {
    const test::TestFolder folder("output-kept");
    for (const fs::path& inner :
         {folder.path() / "a" / "b", folder.path() / "c" / "d" / "", folder.path() / "a" / "b"}) {
        ASSERT_TRUE(write_into_folder(inner, std::vector<FileContent>{{inner / "file", "text"}}));
        EXPECT_EQ(contents(inner / "file"), "text");
    }
}

TEST(Folders, ImpossibleFoldersAreErrors) {
    const test::TestFolder folder("output-bad");
    test::overwrite(folder.path() / "file", "x");
    for (const fs::path& bad : {folder.path() / "file", folder.path() / "file" / "inner"}) {
        const auto made = MadeFolder::make(bad);
        ASSERT_FALSE(made);
        EXPECT_NE(made.error().message.find("cannot create the folder"), std::string::npos) << made.error().message;
    }
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(WritePng, RoundTripWithinHalfALevel) {
    Image image(16, 8);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = {static_cast<float>(i) / 127, 0.5f, static_cast<float>(i) / 20 - 1};
    const auto png = encode_png(to_srgb(image, 2));
    ASSERT_TRUE(png);
    const auto loaded = read_ldr(std::as_bytes(std::span(*png)), "picture.png", {.ldr = true});
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        // The sRGB curve is steepest near white: a level is 1 / 255 * 2.4 / 1.055 there.
        const auto expected = [](float c) { return std::clamp(2 * c, 0.0f, 1.0f); };
        EXPECT_NEAR(loaded->image.pixels[i].r, expected(image.pixels[i].r), 0.5 / 255 * 2.28);
        EXPECT_NEAR(loaded->image.pixels[i].b, expected(image.pixels[i].b), 0.5 / 255 * 2.28);
    }
}

TEST(ToneCurve, RisesFromBlackToWhite) {
    for (const ToneCurve curve : {ToneCurve::clamp, ToneCurve::reinhard, ToneCurve::filmic}) {
        EXPECT_EQ(toned(curve, 0), 0);
        EXPECT_EQ(toned(curve, -1), 0);
        EXPECT_EQ(toned(curve, std::numeric_limits<double>::quiet_NaN()), 0);
        EXPECT_NEAR(toned(curve, std::numeric_limits<double>::infinity()), 1, 1e-6);
        double before = 0;
        for (double x = 1e-4; x < 100; x *= 1.1) {
            EXPECT_GE(toned(curve, x), before);
            EXPECT_LE(before = toned(curve, x), 1);
        }
    }
    // Values brighter than white differ, unless the curve clips them.
    Image image(2, 1);
    image.pixels = {{1.0f, 1.0f, 1.0f}, {2.0f, 2.0f, 2.0f}};
    const auto levels = [&](ToneCurve curve) {
        const Image8 picture = to_srgb(image, 1, curve);
        return std::pair(picture.rgb[0], picture.rgb[3]);
    };
    EXPECT_EQ(levels(ToneCurve::clamp), (std::pair<std::uint8_t, std::uint8_t>(255, 255)));
    EXPECT_LT(levels(ToneCurve::filmic).first, levels(ToneCurve::filmic).second);
    EXPECT_EQ(levels(ToneCurve::reinhard).first, 188);  // one half
}

}  // namespace
}  // namespace lobelia
