// Tests that a bake's folder is always one bake: commits that were interrupted, checksums, files left behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include "bake/write/bake_fields.h"
#include "bake/write/files_together.h"
#include "bake/write/manifest.h"
#include "bake_files.h"
#include "folders.h"
#include "io/commit_journal.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

class CommittedBake : public testing::Test {
  protected:
    [[nodiscard]] const fs::path& path() const { return folder_.path(); }
    [[nodiscard]] std::string message() const {
        const auto bake = read_bake(path());
        return bake ? "" : bake.error().message;
    }
    static Bake named(const std::string& name) {
        Bake bake = test::some_bake("sh1/moments/convolution");
        bake.manifest.scene_name = name;
        return bake;
    }

  private:
    test::TestFolder folder_{"committed"};
};

TEST_F(CommittedBake, DamagedAndForeignFilesAreNamed) {
    ASSERT_TRUE(write_bake(path(), named("a")));
    const auto manifest = read_manifest(path());
    ASSERT_TRUE(manifest);
    EXPECT_GE(manifest->files.size(), 5u);
    for (const char* name : {"page-0.exr", "page-1.exr", "probes.json", "probes.bin"}) {
        const std::string good = test::contents(path() / name);
        std::string bad = good;
        bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
        for (const std::string& content : {bad, good + "x", good.substr(1)}) {
            test::overwrite(path() / name, content);
            EXPECT_NE(message().find(std::string(name) + ": damaged"), std::string::npos) << message();
        }
        test::overwrite(path() / name, good);
        EXPECT_EQ(message(), "");
        // A link to the same content is not a file of this folder.
        fs::rename(path() / name, path() / "other");
        fs::create_symlink("other", path() / name);
        EXPECT_NE(message().find("a symbolic link"), std::string::npos) << message();
        fs::rename(path() / "other", path() / name);
    }
}

TEST_F(CommittedBake, BakesWithoutChecksumsAreRead) {
    ASSERT_TRUE(write_bake(path(), named("a")));
    std::string text = test::contents(path() / "bake.json");
    const auto begin = text.find("\"files\""), end = text.find("],", begin) + 2;
    test::overwrite(path() / "bake.json", text.erase(begin, end - begin));
    EXPECT_EQ(message(), "");
}

/// Writes the journal of a commit of these files, as it is before its first step.
void interrupt(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& renames,
               const std::vector<std::string>& removals = {}) {
    nlohmann::ordered_json steps = nlohmann::ordered_json::array();
    for (const auto& [from, to] : renames) steps.push_back({{"from", from}, {"to", to}});
    const nlohmann::ordered_json journal = {{"lobelia_commit", 1}, {"renames", steps}, {"removals", removals}};
    test::overwrite(folder / ".lobelia.commit", journal.dump());
}

TEST_F(CommittedBake, AnInterruptedCommitIsReadAsItWillBe) {
    // A new bake waits under temporary names in the folder of an older one; some files are in place already.
    ASSERT_TRUE(write_bake(path() / "new", named("new")));
    Bake older = named("older");
    older.pages[0].planes[0][0] = 5;
    for (const std::size_t in_place : {0u, 1u, 3u, 5u}) {
        fs::remove_all(path() / "a");
        ASSERT_TRUE(write_bake(path() / "a", older));
        test::overwrite(path() / "a" / "bake.html", "older");
        std::vector<std::pair<std::string, std::string>> renames;
        for (const auto& entry : fs::directory_iterator(path() / "new"))
            renames.emplace_back(".lobelia-1-" + std::to_string(renames.size()) + "-0.tmp",
                                 entry.path().filename().string());
        for (std::size_t i = 0; i < renames.size(); ++i)
            fs::copy_file(path() / "new" / renames[i].second,
                          path() / "a" / (i < in_place ? renames[i].second : renames[i].first),
                          fs::copy_options::overwrite_existing);
        interrupt(path() / "a", renames, {"bake.html"});
        test::overwrite(path() / "a" / ".lobelia-1-ffff-0.tmp", "left behind");
        // Readers see the new one, and change nothing.
        const auto count = [&] {
            return std::distance(fs::directory_iterator(path() / "a"), fs::directory_iterator());
        };
        const auto before = count();
        auto read = read_bake(path() / "a");
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->manifest.scene_name, "new");
        EXPECT_EQ(count(), before);
        // The next writer completes it, and clears the rest.
        ASSERT_TRUE(lock_folder(path() / "a"));
        read = read_bake(path() / "a");
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->manifest.scene_name, "new");
        EXPECT_FALSE(fs::exists(path() / "a" / "bake.html"));
        for (const auto& entry : fs::directory_iterator(path() / "a"))
            EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
    }
}

TEST_F(CommittedBake, JournalsReachNothingElsewhere) {
    const fs::path folder = path() / "a";
    const std::string temporary = ".lobelia-1-1-0.tmp";
    fs::create_directories(folder);
    test::overwrite(path() / "precious", "precious");
    const auto refused = [&] {
        const auto lock = lock_folder(folder);
        return !lock && test::contents(path() / "precious") == "precious" ? lock.error().message : "";
    };
    test::overwrite(folder / temporary, "x");
    for (const std::string& elsewhere : {std::string("../precious"), (path() / "precious").string(),
                                         std::string("../a/../precious"), std::string(".."), std::string("")}) {
        interrupt(folder, {{temporary, elsewhere}});
        EXPECT_NE(refused().find("not a file of this folder"), std::string::npos) << elsewhere;
        interrupt(folder, {}, {elsewhere});
        EXPECT_NE(refused().find("not a file of this folder"), std::string::npos) << elsewhere;
        interrupt(folder, {{elsewhere, "page-0.exr"}});
        EXPECT_NE(refused(), "") << elsewhere;
        EXPECT_FALSE(read_bake(folder));
    }
    fs::create_directory_symlink(path(), folder / "checkpoint");
    interrupt(folder, {}, {"checkpoint/precious"});
    EXPECT_NE(refused().find("symbolic link"), std::string::npos);
    interrupt(folder, {{"notes.txt", "page-0.exr"}});
    EXPECT_NE(refused().find("not a temporary name"), std::string::npos);
    test::overwrite(folder / ".lobelia.commit", "{");
    EXPECT_NE(refused().find(".lobelia.commit"), std::string::npos);
}

TEST_F(CommittedBake, TemporaryFilesOfOthersStay) {
    const auto staged = StagedFile::create(path() / "picture.png");
    ASSERT_TRUE(staged);
    // One that a living process holds, one that a killed one left, and names that are not Lobelia's.
    test::overwrite(path() / ".lobelia-1-1-0.tmp", "held");
    const int held = ::open((path() / ".lobelia-1-1-0.tmp").c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(held, LOCK_EX), 0);
    test::overwrite(path() / ".lobelia-1-2-0.tmp", "left");
    for (const char* name : {".lobelia-1-2.tmp", ".lobelia-x-1-0.tmp", "lobelia-1-1-0.tmp", ".lobelia-1-1-0.tmp~"})
        test::overwrite(path() / name, "mine");
    ASSERT_TRUE(lock_folder(path()));
    EXPECT_TRUE(fs::exists(path() / ".lobelia-1-1-0.tmp"));
    EXPECT_FALSE(fs::exists(path() / ".lobelia-1-2-0.tmp"));
    EXPECT_TRUE(fs::exists(path() / ".lobelia-1-2.tmp"));
    EXPECT_TRUE(fs::exists(path() / ".lobelia-x-1-0.tmp"));
    ::close(held);
}

TEST_F(CommittedBake, FilesOfTheOlderBakeAreRemoved) {
    ASSERT_TRUE(write_bake(path(), named("a"), {.textures = {.storages = {{"float32"}}}}));
    test::overwrite(path() / "page-notes.txt", "mine");
    test::overwrite(path() / "bake.html", "older");
    ASSERT_TRUE(fs::exists(path() / "page-0.float32.rgba32f.ktx2"));
    Bake bake = named("b");
    bake.probes.reset();
    ASSERT_TRUE(write_bake(path(), bake, {.textures = {.storages = {{"float16"}}}}));
    EXPECT_FALSE(fs::exists(path() / "page-0.float32.rgba32f.ktx2"));
    EXPECT_FALSE(fs::exists(path() / "probes.bin"));
    EXPECT_FALSE(fs::exists(path() / "bake.html"));
    EXPECT_TRUE(fs::exists(path() / "page-0.float16.rgba16f.ktx2"));
    EXPECT_TRUE(fs::exists(path() / "page-notes.txt"));
    EXPECT_EQ(message(), "");
}

TEST_F(CommittedBake, OutputsReplaceLinksInsteadOfFollowingThem) {
    test::overwrite(path() / "precious", "precious");
    fs::create_directory(path() / "a");
    fs::create_symlink("../precious", path() / "a" / "page-0.exr");
    ASSERT_TRUE(write_bake(path() / "a", named("a")));
    EXPECT_EQ(test::contents(path() / "precious"), "precious");
    EXPECT_FALSE(fs::is_symlink(path() / "a" / "page-0.exr"));
    EXPECT_TRUE(read_bake(path() / "a"));
}

}  // namespace
}  // namespace lobelia
