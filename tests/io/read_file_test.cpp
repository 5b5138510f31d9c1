// Tests that only regular files are opened: no reader waits for a pipe or reads a device without end.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "folders.h"
#include "io/read_exr_channels.h"
#include "io/read_file.h"
#include "io/read_image.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

class ReadFile : public ::testing::Test {
  protected:
    ReadFile() : holder_(::testing::UnitTest::GetInstance()->current_test_info()->name()), folder_(holder_.path()) {}

    test::TestFolder holder_;
    fs::path folder_;
};

std::string message_of(const fs::path& path, const InputOptions& options = {}) {
    const auto file = InputFile::open(path, options);
    return file ? "" : file.error().message;
}

/// Returns the messages of all readers for a path.
std::vector<std::string> messages_of(const fs::path& path) {
    const auto message = [](const auto& result) { return result ? std::string() : result.error().message; };
    return {message(InputFile::open(path)), message(read_file(path, 100)), message(read_text(path)),
            message(read_environment(path)), message(read_exr_channels(path))};
}

void expect_refused(const fs::path& path, const std::string& reason) {
    for (const std::string& message : messages_of(path)) {
        EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0u) << message;
        EXPECT_NE(message.find(reason), std::string::npos) << message;
    }
}

TEST_F(ReadFile, RoundTrip) {
    const std::string text("with\0zero", 9);
    test::overwrite(folder_ / "file", text);
    EXPECT_EQ(read_text(folder_ / "file").value(), text);
    EXPECT_EQ(read_file(folder_ / "file", 9).value().size(), 9u);
    const auto file = InputFile::open(folder_ / "file");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->size(), 9u);
    std::array<std::byte, 4> end{};
    ASSERT_TRUE(file->read(5, end));
    EXPECT_EQ(std::memcmp(end.data(), "zero", 4), 0);
    EXPECT_FALSE(file->read(6, end));
    EXPECT_FALSE(file->read(1 << 20, end));
}

TEST_F(ReadFile, PipesDevicesSocketsAndFoldersAreRefusedAtOnce) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    expect_refused(folder_ / "pipe", "a pipe, not a regular file");
    expect_refused(folder_, "a folder, not a regular file");
    for (const char* device : {"/dev/zero", "/dev/null"}) expect_refused(device, "a device, not a regular file");

    const int made = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, (folder_ / "socket").c_str(), sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    expect_refused(folder_ / "socket", "a socket, not a regular file");
    ::close(made);
}

TEST_F(ReadFile, LinksLeadToFilesUnlessRefused) {
    test::overwrite(folder_ / "file", "text");
    fs::create_symlink("file", folder_ / "link");
    fs::create_symlink("nowhere", folder_ / "dangling");
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    fs::create_symlink("pipe", folder_ / "to-pipe");
    EXPECT_EQ(message_of(folder_ / "link"), "");
    const InputOptions strict{.links = InputOptions::Links::refused};
    EXPECT_EQ(message_of(folder_ / "file", strict), "");
    EXPECT_NE(message_of(folder_ / "link", strict).find("a symbolic link"), std::string::npos);
    expect_refused(folder_ / "to-pipe", "a pipe");
    expect_refused(folder_ / "dangling", "No such file");
}

/// Folders that others have filled: no component leads elsewhere.
TEST_F(ReadFile, BelowAFolderNothingLeadsOutOfIt) {
    const fs::path inside = folder_ / "inside";
    fs::create_directories(inside / "deep");
    test::overwrite(folder_ / "secret", "secret");
    test::overwrite(inside / "deep" / "file", "text");
    fs::create_directory_symlink(folder_, inside / "up");
    fs::create_directory_symlink("deep", inside / "beside");
    fs::create_symlink(folder_ / "secret", inside / "link");
    fs::create_symlink(inside, folder_ / "named");
    const auto message = [&](const fs::path& folder, const fs::path& relative) {
        const auto file = InputFile::open_below(folder, relative);
        return file ? std::string("opened") : file.error().message;
    };
    EXPECT_EQ(message(inside, "deep/file"), "opened");
    EXPECT_EQ(message(folder_ / "named", "deep/file"), "opened") << "the user named this link";
    for (const char* relative : {"up/secret", "beside/file"})
        EXPECT_NE(message(inside, relative).find("is a symbolic link or a file, not a folder"), std::string::npos)
            << relative << ": " << message(inside, relative);
    EXPECT_NE(message(inside, "link").find("a symbolic link, not a regular file"), std::string::npos);
    EXPECT_NE(message(inside, "../secret").find("leads out"), std::string::npos);
    EXPECT_NE(message(inside, (folder_ / "secret").string()).find("not a file below"), std::string::npos);
    EXPECT_NE(message(inside, "").find("not a file below"), std::string::npos);
    ASSERT_EQ(::mkfifo((inside / "pipe").c_str(), 0600), 0);
    EXPECT_NE(message(inside, "pipe").find("a pipe"), std::string::npos);
}

TEST_F(ReadFile, LimitsHoldBeforeAllocation) {
    // Make a sparse file of 1 TiB.
    test::overwrite(folder_ / "large", "");
    fs::resize_file(folder_ / "large", std::uintmax_t{1} << 40);
    EXPECT_NE(message_of(folder_ / "large", {.most_bytes = 100}).find("at most 100"), std::string::npos);
    EXPECT_FALSE(read_file(folder_ / "large", 100));
    EXPECT_FALSE(read_text(folder_ / "large"));
    EXPECT_FALSE(read_environment(folder_ / "large"));
    EXPECT_FALSE(read_exr_channels(folder_ / "large"));
}

}  // namespace
}  // namespace lobelia
