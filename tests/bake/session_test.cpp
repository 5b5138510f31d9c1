// Tests bakes in several sessions: shards that make a whole or not, what a job may say, folders in use, ways on.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <set>

#include "bake/check_job.h"
#include "bake/session/checkpoint.h"
#include "bake/session/job_file.h"
#include "bake/session/setup.h"
#include "bake/write/bake_fields.h"
#include "folders.h"
#include "lobelia/bake.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;
using Start = BakeSession::Start;

BakeJob tiny_job() {
    BakeJob job;
    job.bake.atlas.width = job.bake.atlas.height = 64;  // several tiles
    job.bake.samples = 64;
    job.bake.paths.bounces = 1;
    job.bake.threads = 1;
    job.finish = {Switch::off, Switch::off, Switch::off};
    job.textures.storages.emplace();
    return job;
}

const Scene& box() {
    static const Scene scene = cornell_scene({.closed = true});
    return scene;
}

/// The message of a bake in a folder, or nothing.
std::string bake_in(const fs::path& folder, const BakeJob& job, Start start = Start::fresh) {
    BakeSession session{.folder = folder, .start = start};
    const auto baked = bake(box(), job, session);
    return baked ? "" : baked.error().message;
}

class Sessions : public testing::Test {
  protected:
    [[nodiscard]] fs::path operator/(const std::string& name) const { return folder_.path() / name; }
    /// Bakes a shard and returns its folder.
    fs::path shard(const Shard& shard, std::uint32_t samples = 64) {
        BakeJob job = tiny_job();
        job.bake.shard = shard;
        job.bake.samples = samples;
        const fs::path folder = *this / ("part" + std::to_string(parts_++));
        EXPECT_EQ(bake_in(folder, job), "");
        return folder;
    }
    std::string merged(const std::vector<fs::path>& parts) {
        BakeSession session{.folder = *this / "whole"};
        const auto bake = merge_bake(box(), tiny_job(), parts, session);
        fs::remove_all(session.folder);
        return bake ? "" : bake.error().message;
    }

  private:
    test::TestFolder folder_{"sessions"};
    int parts_ = 0;
};

TEST_F(Sessions, ShardsOfSamplesMustHoldEachPassOnce) {
    using By = Shard::By;
    const auto of_samples = [&](std::uint32_t i, std::uint32_t n) { return shard({By::samples, i, n}); };
    const fs::path half0 = of_samples(0, 2), half1 = of_samples(1, 2), third = of_samples(1, 3),
                   quarter2 = of_samples(2, 4), quarter3 = of_samples(3, 4);
    EXPECT_EQ(merged({half0, half1}), "");
    EXPECT_EQ(merged({half1, half0}), "");
    // Shards of other counts whose passes are the whole all the same.
    EXPECT_EQ(merged({half0, quarter2, quarter3}), "");
    // One alone, either; two that leave a gap or overlap; one twice.
    EXPECT_NE(merged({half0}).find("missing: passes 2 to 3 of 4"), std::string::npos) << merged({half0});
    EXPECT_NE(merged({half1}).find("missing: passes 0 to 1 of 4"), std::string::npos);
    EXPECT_NE(merged({half0, quarter3}).find("missing: pass 2 of 4, after those of " + half0.string()),
              std::string::npos);
    EXPECT_NE(
        merged({half0, third}).find("given twice: pass 1 of 4, by " + half0.string() + " and by " + third.string()),
        std::string::npos)
        << merged({half0, third});
    EXPECT_NE(merged({half0, half0, half1}).find("given twice"), std::string::npos);
    // A shard of a bake with more samples.
    EXPECT_NE(merged({half0, half1, shard({By::samples, 1, 2}, 128)}).find("more than the 4"), std::string::npos);
    // A half that has the first of its two passes: the message says how to continue it.
    const fs::path unfinished = shard({By::samples, 0, 2}, 32);
    EXPECT_NE(merged({unfinished, half1}).find("missing: pass 1 of 4"), std::string::npos);
    EXPECT_NE(merged({unfinished, half1}).find("--resume"), std::string::npos);
}

TEST_F(Sessions, TileShardsMustHoldEachTileOnce) {
    const fs::path a = shard({Shard::By::tiles, 0, 2}), b = shard({Shard::By::tiles, 1, 2});
    EXPECT_EQ(merged({a, b}), "");
    EXPECT_NE(merged({a, shard({Shard::By::tiles, 1, 2}, 32)}), "");
    EXPECT_NE(merged({a, shard({Shard::By::tiles, 0, 3})}), "");
}

TEST_F(Sessions, JobFilesAreUnderstoodCompletelyOrRefused) {
    ASSERT_EQ(bake_in(*this / "a", tiny_job()), "");
    const fs::path file = *this / "a" / "checkpoint" / "job.json";
    const std::string good = test::contents(file);
    struct Case {
        std::string from, to, says;
    };
    for (const Case& c :
         std::vector<Case>{{"\"samples\": 64", "\"samples\": 4294967295", "samples = 4294967295 is out"},
                           {"\"samples\": 64", "\"samples\": 0", "samples = 0 is out of range"},
                           {"\"samples\": 64", "\"sample\": 64", "bake.sample: unknown"},
                           {"\"samples_per_pass\": 16", "\"samples_per_pass\": 0", "samples per pass"},
                           {"\"samples_per_pass\": 16", "\"samples_per_pass\": 24", "multiple of 16"},
                           {"\"bounces\": 1", "\"bounces\": 65", "bounces = 65"},
                           {"\"padding\": 2", "\"padding\": 65", "padding = 65"},
                           {"\"memory\"", "\"memori\"", "memori: unknown"},
                           {"\"denoise\"", "\"denoisy\"", "finish.denoisy: unknown"},
                           {"\"uv_set\": 1", "\"uv_set\": 99", "uv set"},
                           {"\"scene_memory\": null", "\"scene_memory\": 1", "scene memory = 1 is out of range"},
                           {"{", "{\"codek\": 1,", "codek: unknown"}}) {
        std::string text = good;
        const auto found = text.find(c.from);
        ASSERT_NE(found, std::string::npos) << c.from;
        test::overwrite(file, text.replace(found, c.from.size(), c.to));
        const auto job = read_job(*this / "a");
        ASSERT_FALSE(job) << c.to;
        EXPECT_NE(job.error().message.find(c.says), std::string::npos) << job.error().message;
        EXPECT_NE(job.error().message.find("job.json"), std::string::npos) << job.error().message;
    }
    test::overwrite(file, good);
    EXPECT_TRUE(read_job(*this / "a"));
}

TEST_F(Sessions, NumbersOfJobsBeyondFloatBecomeTheLargest) {
    ASSERT_EQ(bake_in(*this / "a", tiny_job()), "");
    const fs::path file = *this / "a" / "checkpoint" / "job.json";
    std::string text = test::contents(file);
    const std::string none = "\"probes\": null";
    ASSERT_NE(text.find(none), std::string::npos);
    text.replace(
        text.find(none), none.size(),
        R"("probes": {"box": {"lowest": {"x": -1e300, "y": 0, "z": 0}, "highest": {"x": 1e300, "y": 1, "z": 1}}})");
    test::overwrite(file, text);
    const auto job = read_job(*this / "a");
    ASSERT_TRUE(job) << job.error().message;
    ASSERT_TRUE(job->probes && job->probes->box);
    EXPECT_EQ((*job->probes->box)[0].x, std::numeric_limits<float>::lowest());
    EXPECT_EQ((*job->probes->box)[1].x, std::numeric_limits<float>::max());
}

TEST_F(Sessions, OptionsOutOfRangeAreRefusedByTheBakeItself) {
    const std::vector<std::function<void(BakeJob&)>> changes = {
        [](BakeJob& j) { j.bake.samples = 0; },
        [](BakeJob& j) { j.bake.samples = 4294967295; },
        [](BakeJob& j) { j.bake.samples_per_pass = 0; },
        [](BakeJob& j) { j.bake.samples_per_pass = 8; },
        [](BakeJob& j) { j.bake.paths.bounces = -1; },
        [](BakeJob& j) { j.bake.target_error = std::nan(""); },
        [](BakeJob& j) { j.bake.atlas.width = 0; },
        [](BakeJob& j) { j.bake.shard.count = 0; },
        [](BakeJob& j) { j.probes.emplace().samples = 0; },
        [](BakeJob& j) { j.scene.scene_memory = 1; },
    };
    for (const auto& change : changes) {
        BakeJob job = tiny_job();
        change(job);
        EXPECT_NE(bake_in(*this / "b", job), "");
        EXPECT_FALSE(preflight(box(), job));
        EXPECT_FALSE(fs::exists(*this / "b"));
    }
}

/// Changes one field of a job at a time: the `target`-th that `fields` visits.
class FieldChanger {
  public:
    explicit FieldChanger(std::size_t target) : target_(target) {}
    template <class T>
    void whole(const char* name, T& value, std::uint64_t, std::uint64_t) {
        if (is_it(name)) value = static_cast<T>(value + 16);
    }
    void number(const char* name, double& value) {
        if (is_it(name)) value += 1;
    }
    void number(const char* name, std::optional<double>& value) {
        if (is_it(name)) value = value.value_or(0) + 0.25;
    }
    void text(const char* name, std::string& value) {
        if (is_it(name))
            value = value == "sh2/moments/convolution" ? "sh1/moments/convolution" : "sh2/moments/convolution";
    }
    void text(const char* name, std::optional<std::string>& value) {
        if (is_it(name)) value = "#1";
    }
    void texts(const char* name, std::optional<std::vector<std::string>>& value) {
        if (is_it(name)) value = {"float32"};
    }
    template <class Enum, std::size_t N>
    void choice(const char* name, Enum& value, const std::array<const char*, N>&) {
        if (is_it(name)) value = static_cast<Enum>((static_cast<std::size_t>(value) + 1) % N);
    }
    template <class T>
    void group(const char* name, T& value) {
        const std::string outer = path_;
        path_ += std::string(name) + ".";
        fields(*this, value);
        path_ = outer;
    }
    std::string changed;  ///< path of the field; empty: there are no more

  private:
    bool is_it(const char* name) {
        if (count_++ != target_) return false;
        changed = path_ + name;
        return true;
    }
    std::size_t target_, count_ = 0;
    std::string path_;
};

TEST_F(Sessions, TheHashOfStatesHasEveryOption) {
    // Those that the header of the states has itself, or that do not change the states.
    const std::set<std::string> others = {"bake.samples",  "bake.samples_per_pass", "bake.most_seconds",
                                          "bake.shard.by", "bake.shard.index",      "bake.shard.count"};
    const auto options = [](auto& archive, BakeOptions& bake) {
        archive.group("bake", bake);
        archive.text("codec", bake.codec);
        archive.choice("frame", bake.frame, std::array{"tangent", "world"});
        archive.whole("width", bake.atlas.width, 0, 0);
        archive.whole("height", bake.atlas.height, 0, 0);
    };
    const std::uint64_t hash = state_hash(box(), BakeOptions());
    for (std::size_t field = 0;; ++field) {
        BakeOptions changed;
        FieldChanger changer(field);
        options(changer, changed);
        if (changer.changed.empty()) {
            EXPECT_GT(field, 15u);
            break;
        }
        EXPECT_EQ(state_hash(box(), changed) == hash, others.contains(changer.changed)) << changer.changed;
    }
}

TEST_F(Sessions, SamplesAreNotAddedTwice) {
    BakeJob job = tiny_job();
    ASSERT_EQ(bake_in(*this / "a", job), "");
    // Stop an addition after one pass of several: the count is raised already.
    job.bake.samples = 256;
    std::atomic<bool> stop = false;
    BakeSession session{.folder = *this / "a", .start = Start::resume, .stop = &stop};
    session.progress = [&](const BakeProgress& p) { stop = p.pass > 6; };
    ASSERT_FALSE(bake(box(), job, session));
    EXPECT_EQ(read_job(*this / "a")->bake.samples, 256u);
    BakeJob more = job;
    more.bake.samples = 320;
    const std::string refused = bake_in(*this / "a", more, Start::resume);
    EXPECT_NE(refused.find("--resume"), std::string::npos) << refused;
    EXPECT_EQ(read_job(*this / "a")->bake.samples, 256u);
    EXPECT_EQ(bake_in(*this / "a", job, Start::resume), "");
    EXPECT_EQ(bake_in(*this / "a", more, Start::resume), "");
    EXPECT_EQ(read_bake(*this / "a")->manifest.statistics.samples, 320u);
}

TEST_F(Sessions, AShardOfSamplesGetsNoMore) {
    const fs::path part = shard({Shard::By::samples, 0, 2});
    BakeJob job = *read_job(part);
    job.bake.samples = 128;
    EXPECT_NE(bake_in(part, job, Start::resume).find("merge the shards"), std::string::npos);
    EXPECT_EQ(read_job(part)->bake.samples, 64u);
}

TEST_F(Sessions, NothingIsResumedAfterAnObjectWasBakedAgain) {
    const BakeJob job = tiny_job();
    ASSERT_EQ(bake_in(*this / "a", job), "");
    BakeSession session{.folder = *this / "a"};
    const auto again = rebake_object(box(), job, "#1", *read_bake(*this / "a"), session);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_FALSE(fs::exists(*this / "a" / "checkpoint" / "region-0000.state"));
    const std::string refused = bake_in(*this / "a", job, Start::resume);
    EXPECT_NE(refused.find("baked again (#1)"), std::string::npos) << refused;
    // Another object may follow; a fresh bake may, too.
    EXPECT_TRUE(rebake_object(box(), job, "#2", *read_bake(*this / "a"), session));
    EXPECT_EQ(bake_in(*this / "a", job), "");
    EXPECT_EQ(bake_in(*this / "a", job, Start::resume), "");
}

TEST_F(Sessions, AnObjectIsBakedAgainWithTheOptionsOfItsBake) {
    BakeJob job = tiny_job();
    ASSERT_EQ(bake_in(*this / "a", job), "");
    Bake there = *read_bake(*this / "a");
    job.bake.samples = 128;
    BakeSession session{.folder = *this / "a"};
    const auto again = rebake_object(box(), job, "#1", there, session);
    ASSERT_FALSE(again);
    EXPECT_NE(again.error().message.find("--resume"), std::string::npos) << again.error().message;
}

TEST_F(Sessions, AFolderHasOneWriter) {
    const BakeJob job = tiny_job();
    {
        const auto lock = lock_folder(*this / "a");
        ASSERT_TRUE(lock) << lock.error().message;
        for (const std::string& refused : {bake_in(*this / "a", job), lock_folder(*this / "a").error().message,
                                           write_bake(*this / "a", Bake()).error().message}) {
            EXPECT_NE(refused.find("process " + std::to_string(::getpid())), std::string::npos) << refused;
            EXPECT_NE(refused.find("second"), std::string::npos) << refused;
        }
        // Its owner may bake.
        BakeSession session{.folder = *this / "a", .lock = *lock};
        EXPECT_TRUE(bake(box(), job, session));
    }
    EXPECT_TRUE(lock_folder(*this / "a"));
    EXPECT_FALSE(fs::exists(*this / "a" / ".lobelia.lock"));
    // An empty folder that was made for it goes with the lock.
    EXPECT_TRUE(lock_folder(*this / "b" / "c"));
    EXPECT_FALSE(fs::exists(*this / "b"));
}

}  // namespace
}  // namespace lobelia
