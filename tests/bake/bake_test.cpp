// Tests the whole bake: the same bits however the work is divided, and correct light.
#include "lobelia/bake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "bake/session/checkpoint.h"
#include "bake/session/setup.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// A folder for one test, removed with it.
class Folder {
  public:
    Folder() {
        std::string name = (fs::temp_directory_path() / "lobelia-bake-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] fs::path operator/(std::string_view name) const {
        fs::create_directories(path_ / name);
        return path_ / name;
    }

  private:
    fs::path path_;
};

const Scene& grey_room() {
    static const Scene scene = cornell_scene({.closed = true});
    return scene;
}

/// A small job without finishing steps: its pages are as they were solved.
BakeJob small_job() {
    BakeJob job;
    job.bake.atlas.width = job.bake.atlas.height = 64;
    job.bake.samples = 64;
    job.bake.paths.bounces = 4;
    job.bake.threads = 2;
    job.finish = {Switch::off, Switch::off, Switch::off};
    job.textures.storages.emplace();
    job.precision = Precision::full;
    return job;
}

using Start = BakeSession::Start;

BakeSession session_in(const fs::path& folder, Start start = Start::fresh) {
    BakeSession session;
    session.folder = folder;
    session.start = start;
    return session;
}

Bake baked(const Scene& scene, const BakeJob& job, BakeSession session = {}) {
    auto result = bake(scene, job, session);
    EXPECT_TRUE(result) << result.error().message;
    return result ? *std::move(result) : Bake();
}

std::string error_of(const Scene& scene, const BakeJob& job, BakeSession session = {}) {
    const auto result = bake(scene, job, session);
    return result ? std::string() : result.error().message;
}

void expect_same_bits(const Bake& first, const Bake& second) {
    const auto &a = first.pages, &b = second.pages;
    ASSERT_EQ(a.size(), b.size());
    ASSERT_FALSE(a.empty());
    for (std::size_t p = 0; p < a.size(); ++p) {
        EXPECT_EQ(a[p].chart, b[p].chart);
        EXPECT_EQ(a[p].validity, b[p].validity);
        for (std::size_t k = 0; k < a[p].planes.size(); ++k) EXPECT_EQ(a[p].planes[k], b[p].planes[k]) << "plane " << k;
    }
}

TEST(Bake, IsTheSameAtAnyNumberOfThreads) {
    BakeJob job = small_job();
    const Bake two = baked(grey_room(), job);
    job.bake.threads = 1;
    expect_same_bits(two, baked(grey_room(), job));
}

TEST(Bake, IsTheSameInRegionsThatFitTheMemory) {
    BakeJob job = small_job();
    const Bake whole = baked(grey_room(), job);
    // The least memory that is enough makes the most regions.
    std::size_t too_little = 0, enough = std::size_t{1} << 30;
    while (enough - too_little > 1024) {
        job.bake.memory = (too_little + enough) / 2;
        (BakeSetup::make(grey_room(), job.bake) ? enough : too_little) = job.bake.memory;
    }
    job.bake.memory = enough;
    const auto setup = BakeSetup::make(grey_room(), job.bake);
    ASSERT_TRUE(setup);
    ASSERT_GE((*setup)->plan.regions.size(), 3u);
    expect_same_bits(whole, baked(grey_room(), job));
}

TEST(Bake, ResumeEqualsUninterrupted) {
    const Folder folder;
    const BakeJob job = small_job();
    const Bake whole = baked(grey_room(), job);
    // Stop in the middle of a pass, again and again.
    for (int stops = 0; stops < 3; ++stops) {
        std::atomic<bool> stop = false;
        BakeSession session = session_in(folder / "a", stops == 0 ? Start::fresh : Start::resume);
        session.stop = &stop;
        session.progress = [&](const BakeProgress& progress) {
            if (progress.done > 0.3 * (stops + 1) - 0.05) stop = true;
        };
        EXPECT_FALSE(bake(grey_room(), job, session));
    }
    expect_same_bits(whole, baked(grey_room(), job, session_in(folder / "a", Start::resume)));
    // Resuming a finished bake does nothing.
    expect_same_bits(whole, baked(grey_room(), job, session_in(folder / "a", Start::resume)));
}

TEST(Bake, MoreSamplesEqualAsManyFromTheStart) {
    const Folder folder;
    BakeJob job = small_job();
    const Bake whole = baked(grey_room(), job);
    job.bake.samples = 16;
    (void)baked(grey_room(), job, session_in(folder / "a"));
    job.bake.samples = 64;
    expect_same_bits(whole, baked(grey_room(), job, session_in(folder / "a", Start::resume)));
}

TEST(Bake, KeepsItsJobAndItsFolder) {
    const Folder folder;
    BakeJob job = small_job();
    job.scene.path = "a scene";
    job.scene.environment = "sky";
    job.probes.emplace().spacing = 0.5;
    job.probes->box = {Vec3{0.25f, 0.5f, -0.5f}, Vec3{0.5f, 0.75f, 0}};
    const Bake whole = baked(grey_room(), job, session_in(folder / "a"));
    const auto read = read_job(folder / "a");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->scene.path, "a scene");
    EXPECT_EQ(read->scene.environment, "sky");
    EXPECT_EQ(read->probes->box, job.probes->box);
    EXPECT_EQ(read->finish.seams, Switch::off);
    EXPECT_EQ(read->textures.storages, job.textures.storages);
    EXPECT_EQ(read->bake.samples, 64u);
    const auto bake = read_bake(folder / "a");
    ASSERT_TRUE(bake) << bake.error().message;
    expect_same_bits(whole, *bake);
    EXPECT_EQ(bake->probes->coefficients, whole.probes->coefficients);
    EXPECT_EQ(bake->manifest.pages.size(), whole.manifest.pages.size());
}

/// Bakes all shards and merges them.
Bake sharded(BakeJob job, Shard::By by, std::uint32_t count) {
    const Folder folder;
    std::vector<fs::path> parts;
    for (std::uint32_t i = 0; i < count; ++i) {
        job.bake.shard = {by, i, count};
        parts.push_back(folder / std::to_string(i));
        EXPECT_TRUE(baked(grey_room(), job, session_in(parts.back())).pages.empty());
    }
    job.bake.shard = {};
    BakeSession session = session_in(folder / "whole");
    auto merged = merge_bake(grey_room(), job, parts, session);
    EXPECT_TRUE(merged) << merged.error().message;
    return merged ? *std::move(merged) : Bake();
}

TEST(Bake, ShardsOfTilesEqualTheWhole) {
    expect_same_bits(baked(grey_room(), small_job()), sharded(small_job(), Shard::By::tiles, 4));
}

TEST(Bake, ShardsOfSamplesEqualTheWholeToRounding) {
    const auto whole = baked(grey_room(), small_job()).pages,
               merged = sharded(small_job(), Shard::By::samples, 4).pages;
    ASSERT_EQ(whole.size(), merged.size());
    for (std::size_t p = 0; p < whole.size(); ++p)
        for (std::size_t k = 0; k + 1 < whole[p].planes.size(); ++k) {
            float largest = 0, off = 0;
            for (std::size_t i = 0; i < whole[p].size(); ++i) {
                largest = std::max(largest, std::abs(whole[p].planes[k][i]));
                off = std::max(off, std::abs(whole[p].planes[k][i] - merged[p].planes[k][i]));
            }
            EXPECT_LE(off, 1e-6f * largest) << "plane " << k;
        }
}

TEST(Bake, ShardsThatDoNotMakeAWholeAreRefused) {
    const Folder folder;
    BakeJob job = small_job();
    job.bake.samples = 16;
    std::vector<fs::path> parts;
    for (std::uint32_t i = 0; i < 2; ++i) {
        job.bake.shard = {Shard::By::tiles, i, 2};
        parts.push_back(folder / std::to_string(i));
        (void)baked(grey_room(), job, session_in(parts.back()));
    }
    job.bake.shard = {};
    const fs::path whole = folder / "whole";
    const std::vector<fs::path> missing = {parts[0]}, twice = {parts[0], parts[1], parts[1]}, empty = {folder / "none"};
    const auto merges = [&](std::span<const fs::path> shards) {
        BakeSession session = session_in(whole);
        return static_cast<bool>(merge_bake(grey_room(), job, shards, session));
    };
    EXPECT_FALSE(merges(missing));
    EXPECT_FALSE(merges(twice));
    EXPECT_FALSE(merges(empty));
    EXPECT_TRUE(fs::is_empty(whole));
    // Try the shard of another bake, too.
    job.bake.paths.seed = 5;
    EXPECT_FALSE(merges(parts));
}

TEST(Bake, OneObjectIsOneByItsNameAndHasUVs) {
    Scene scene = grey_room();
    BakeJob job = small_job();
    job.bake.samples = 16;
    const auto error_for = [&](const std::string& name) {
        job.bake.only_object = name;
        return error_of(scene, job);
    };
    EXPECT_EQ(error_for("ceiling"), "");
    EXPECT_NE(error_for("cieling").find("did you mean ceiling?"), std::string::npos);
    scene.objects.push_back(scene.objects[1]);
    EXPECT_NE(error_for(scene.objects[1].name).find("2 objects are named"), std::string::npos);
    EXPECT_EQ(error_for("#1"), "");
    EXPECT_NE(error_for("#99").find("no object"), std::string::npos);
    scene.objects[2].name = "bare";
    scene.meshes[scene.objects[2].mesh].lightmap_uv.clear();
    EXPECT_NE(error_for("bare").find("has no lightmap UVs"), std::string::npos);
}

TEST(Bake, AnObjectBakedAgainInTheSameSceneIsTheSame) {
    const BakeJob job = small_job();
    const Bake whole = baked(grey_room(), job);
    Bake damaged = whole;
    const std::vector<std::uint32_t>& object_of_chart = whole.preflight->object_of_chart;
    constexpr std::uint32_t k_object = 1;
    for (LightmapPage& page : damaged.pages)
        for (std::size_t i = 0; i < page.size(); ++i)
            if (page.chart[i] != 0 && object_of_chart[page.chart[i] - 1] == k_object)
                for (auto& plane : page.planes) plane[i] = -1;
    BakeSession session;
    const auto again = rebake_object(grey_room(), job, "#1", damaged, session);
    ASSERT_TRUE(again) << again.error().message;
    expect_same_bits(whole, *again);
}

TEST(Bake, RefusesCheckpointsThatAreNotItsOwn) {
    const Folder folder;
    BakeJob job = small_job();
    job.bake.samples = 16;
    const fs::path out = folder / "a";
    (void)baked(grey_room(), job, session_in(out));
    const fs::path file = region_file(checkpoint_folder(out), 0);
    const auto run = [&](const Scene& scene, const BakeJob& with, Start start) {
        return error_of(scene, with, session_in(out, start));
    };
    // Refuse a checkpoint if not asked to resume, of another scene, and with other options.
    EXPECT_NE(run(grey_room(), job, Start::fresh).find("--resume"), std::string::npos);
    EXPECT_NE(run(cornell_scene(), job, Start::resume).find("another scene"), std::string::npos);
    BakeJob other = job;
    other.bake.paths.bounces = 2;
    EXPECT_NE(run(grey_room(), other, Start::resume).find("other options"), std::string::npos);

    // Truncated anywhere, or with any byte changed.
    std::string bytes;
    {
        std::ifstream in(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto write = [&](const std::string& content) { std::ofstream(file, std::ios::binary) << content; };
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{7}, std::size_t{100}, std::size_t{256}, bytes.size() - 1}) {
        write(bytes.substr(0, size));
        EXPECT_NE(run(grey_room(), job, Start::resume).find("region-0000.state"), std::string::npos) << size;
    }
    for (const std::size_t place : {0u, 9u, 17u, 33u, 49u, 300u, 5000u}) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
        write(damaged);
        EXPECT_NE(run(grey_room(), job, Start::resume), "") << place;
    }
    write(bytes);
    EXPECT_EQ(run(grey_room(), job, Start::resume), "");
}

/// The closed box with every surface of the same reflectance and emission.
Scene furnace(float albedo, float emission) {
    Scene scene = cornell_scene({.closed = true});
    for (Material& material : scene.materials) {
        material.base_color = {albedo, albedo, albedo};
        material.emission = {emission, emission, emission};
        material.double_sided = true;
    }
    return scene;
}

TEST(Bake, WhiteFurnaceAtEveryTexel) {
    BakeJob job = small_job();
    job.bake.samples = 256;
    job.bake.paths.bounces = 64;
    constexpr float albedo = 0.5f, emission = 1;
    const Bake whole = baked(furnace(albedo, emission), job);
    const double expected = k_pi * emission / (1 - albedo);
    const PageChannels channels = whole.channels();
    const LightmapPage& page = whole.pages.front();
    std::size_t texels = 0, beyond = 0;
    double sum = 0;
    for (std::size_t i = 0; i < page.size(); ++i) {
        if (page.chart[i] == 0 || page.validity[i] < 1) continue;
        const double e = page.planes[channels.irradiance(1)][i], error = page.planes[channels.error()][i];
        ++texels;
        sum += e;
        if (std::abs(e - expected) > 3 * error + 1e-3 * expected) ++beyond;
    }
    ASSERT_GT(texels, 500u);
    // 16 passes: Student's t with 15 degrees of freedom is beyond 3 in 0.9 % of cases.
    EXPECT_LT(static_cast<double>(beyond), 0.02 * static_cast<double>(texels)) << "of " << texels;
    EXPECT_NEAR(sum / static_cast<double>(texels), expected, 2e-3 * expected);
}

TEST(Bake, AdaptiveStopsWhereTheErrorIsReached) {
    BakeJob job = small_job();
    job.bake.samples = 512;
    const BakeStatistics all = baked(grey_room(), job).manifest.statistics;
    job.bake.target_error = 0.05;
    const BakeStatistics some = baked(grey_room(), job).manifest.statistics;
    EXPECT_LT(some.rays, all.rays);
    EXPECT_LT(some.mean_error, 0.06);
}

TEST(Bake, StateKeepsToItsSize) {
    // 3 floats for each coefficient, a quarter more, and 16 bytes.
    for (const char* codec : {"sh1/moments/convolution", "sg12h/moments/exact", "sg12h/matrix-gain/exact"}) {
        BakeJob job = small_job();
        job.bake.codec = codec;
        const auto setup = BakeSetup::make(grey_room(), job.bake);
        ASSERT_TRUE(setup);
        const std::size_t floats = 3 * (*setup)->encoding.codec()->basis().size();
        EXPECT_LE(static_cast<double>((*setup)->layout.bytes()), 1.25 * 4 * static_cast<double>(floats) + 16) << codec;
    }
}

}  // namespace
}  // namespace lobelia
