// The bake as a whole: the same bits however it is cut up, and light that is right.
#include "bake/baker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "bake/gather/sites.h"
#include "bake/session/checkpoint.h"
#include "bake/session/merge.h"
#include "bake/session/plan.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// A folder of its own that goes with the test.
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

const Scene& closed_box() {
    static const Scene scene = cornell_scene({.closed = true});
    return scene;
}

BakeOptions small_options() {
    BakeOptions options;
    options.atlas.width = options.atlas.height = 64;
    options.samples = 64;
    options.paths.bounces = 4;
    options.threads = 2;
    return options;
}

const std::atomic<bool> k_never = false;

std::unique_ptr<Baker> make(const Scene& scene, const BakeOptions& options) {
    auto bake = Baker::make(scene, options);
    EXPECT_TRUE(bake) << bake.error().message;
    return std::move(*bake);
}

std::vector<Page> baked(const Scene& scene, const BakeOptions& options, Baker::Start start = Baker::Start::fresh) {
    const auto bake = make(scene, options);
    const auto status = bake->run(start, k_never);
    EXPECT_TRUE(status) << status.error().message;
    return std::move(bake->pages());
}

void expect_same_bits(const std::vector<Page>& a, const std::vector<Page>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t p = 0; p < a.size(); ++p) {
        EXPECT_EQ(a[p].chart, b[p].chart);
        EXPECT_EQ(a[p].validity, b[p].validity);
        for (std::size_t k = 0; k < a[p].planes.size(); ++k) EXPECT_EQ(a[p].planes[k], b[p].planes[k]) << "plane " << k;
    }
}

TEST(Bake, IsTheSameAtAnyNumberOfThreads) {
    BakeOptions options = small_options();
    const auto two = baked(closed_box(), options);
    options.threads = 1;
    expect_same_bits(two, baked(closed_box(), options));
}

TEST(Bake, IsTheSameInRegionsThatFitTheMemory) {
    BakeOptions options = small_options();
    const auto whole = baked(closed_box(), options);
    // The least memory that will do makes the most regions.
    std::size_t too_little = 0, enough = std::size_t{1} << 30;
    while (enough - too_little > 1024) {
        options.memory = (too_little + enough) / 2;
        (Baker::make(closed_box(), options) ? enough : too_little) = options.memory;
    }
    options.memory = enough;
    const auto bake = make(closed_box(), options);
    ASSERT_GE(bake->plan().regions.size(), 3u);
    ASSERT_TRUE(bake->run(Baker::Start::fresh, k_never));
    expect_same_bits(whole, bake->pages());
}

TEST(Bake, ResumeEqualsUninterrupted) {
    const Folder folder;
    BakeOptions options = small_options();
    const auto whole = baked(closed_box(), options);
    options.checkpoint = folder / "a";
    // Stop in the middle of a pass, again and again.
    std::atomic<bool> stop = false;
    for (int stops = 0; stops < 3; ++stops) {
        const auto bake = make(closed_box(), options);
        stop = false;
        const auto status =
            bake->run(stops == 0 ? Baker::Start::fresh : Baker::Start::resume, stop,
                      [&](const BakeProgress& progress) { stop = progress.done > 0.3 * (stops + 1) - 0.05; });
        EXPECT_FALSE(status);
    }
    expect_same_bits(whole, baked(closed_box(), options, Baker::Start::resume));
    // Resuming a finished bake does nothing.
    expect_same_bits(whole, baked(closed_box(), options, Baker::Start::resume));
}

TEST(Bake, MoreSamplesEqualAsManyFromTheStart) {
    const Folder folder;
    BakeOptions options = small_options();
    const auto whole = baked(closed_box(), options);
    options.checkpoint = folder / "a";
    options.samples = 16;
    (void)baked(closed_box(), options);
    options.samples = 64;
    expect_same_bits(whole, baked(closed_box(), options, Baker::Start::resume));
}

/// Bakes all shards and merges them.
std::vector<Page> sharded(BakeOptions options, Shard::By by, std::uint32_t count) {
    const Folder folder;
    std::vector<fs::path> parts;
    for (std::uint32_t i = 0; i < count; ++i) {
        options.shard = {by, i, count};
        options.checkpoint = folder / std::to_string(i);
        parts.push_back(options.checkpoint);
        (void)baked(closed_box(), options);
    }
    options.shard = {};
    options.checkpoint = folder / "whole";
    const auto bake = make(closed_box(), options);
    const auto merged = merge_shards(*bake, parts);
    EXPECT_TRUE(merged) << merged.error().message;
    return baked(closed_box(), options, Baker::Start::resume);
}

TEST(Bake, ShardsOfTilesEqualTheWhole) {
    expect_same_bits(baked(closed_box(), small_options()), sharded(small_options(), Shard::By::tiles, 4));
}

TEST(Bake, ShardsOfSamplesEqualTheWholeToRounding) {
    const auto whole = baked(closed_box(), small_options()), merged = sharded(small_options(), Shard::By::samples, 4);
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
    BakeOptions options = small_options();
    options.samples = 16;
    std::vector<fs::path> parts;
    for (std::uint32_t i = 0; i < 2; ++i) {
        options.shard = {Shard::By::tiles, i, 2};
        options.checkpoint = folder / std::to_string(i);
        parts.push_back(options.checkpoint);
        (void)baked(closed_box(), options);
    }
    options.shard = {};
    options.checkpoint = folder / "whole";
    const auto bake = make(closed_box(), options);
    const std::vector<fs::path> missing = {parts[0]}, twice = {parts[0], parts[1], parts[1]}, empty = {folder / "none"};
    EXPECT_FALSE(merge_shards(*bake, missing));
    EXPECT_FALSE(merge_shards(*bake, twice));
    EXPECT_FALSE(merge_shards(*bake, empty));
    EXPECT_TRUE(fs::is_empty(options.checkpoint));
    // And of another bake.
    options.paths.seed = 5;
    EXPECT_FALSE(merge_shards(*make(closed_box(), options), parts));
}

TEST(Bake, OneObjectIsOneByItsNameAndHasUVs) {
    Scene scene = closed_box();
    BakeOptions options = small_options();
    const auto error_for = [&](const std::string& name) {
        options.only_object = name;
        const auto baker = Baker::make(scene, options);
        return baker ? std::string() : baker.error().message;
    };
    EXPECT_EQ(error_for("ceiling"), "");
    EXPECT_NE(error_for("cieling").find("did you mean ceiling?"), std::string::npos);
    scene.objects.push_back(scene.objects[1]);
    EXPECT_NE(error_for(scene.objects[1].name).find("2 objects are called"), std::string::npos);
    scene.objects[2].name = "bare";
    scene.meshes[scene.objects[2].mesh].lightmap_uv.clear();
    EXPECT_NE(error_for("bare").find("has no lightmap UVs"), std::string::npos);
}

TEST(Bake, RefusesCheckpointsThatAreNotItsOwn) {
    const Folder folder;
    BakeOptions options = small_options();
    options.samples = 16;
    options.checkpoint = folder / "a";
    (void)baked(closed_box(), options);
    const fs::path file = region_file(options.checkpoint, 0);
    const auto run = [&](const Scene& scene, const BakeOptions& with, Baker::Start start) {
        const auto status = make(scene, with)->run(start, k_never);
        return status ? std::string() : status.error().message;
    };
    // Not asked to resume; of another scene; with other options.
    EXPECT_NE(run(closed_box(), options, Baker::Start::fresh).find("--resume"), std::string::npos);
    EXPECT_NE(run(cornell_scene(), options, Baker::Start::resume).find("another scene"), std::string::npos);
    BakeOptions other = options;
    other.paths.bounces = 2;
    EXPECT_NE(run(closed_box(), other, Baker::Start::resume).find("other options"), std::string::npos);

    // Cut off anywhere, or with any byte changed.
    std::string bytes;
    {
        std::ifstream in(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto write = [&](const std::string& content) { std::ofstream(file, std::ios::binary) << content; };
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{7}, std::size_t{100}, std::size_t{256}, bytes.size() - 1}) {
        write(bytes.substr(0, size));
        EXPECT_NE(run(closed_box(), options, Baker::Start::resume).find("region-0000.state"), std::string::npos)
            << size;
    }
    for (const std::size_t place : {0u, 9u, 17u, 33u, 49u, 300u, 5000u}) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ 0x10);
        write(damaged);
        EXPECT_NE(run(closed_box(), options, Baker::Start::resume), "") << place;
    }
    write(bytes);
    EXPECT_EQ(run(closed_box(), options, Baker::Start::resume), "");
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
    BakeOptions options = small_options();
    options.samples = 256;
    options.paths.bounces = 64;
    constexpr float albedo = 0.5f, emission = 1;
    const auto pages = baked(furnace(albedo, emission), options);
    const double expected = k_pi * emission / (1 - albedo);
    const PageLayout layout = make(furnace(albedo, emission), options)->layout();
    const Page& page = pages.front();
    std::size_t texels = 0, beyond = 0;
    double sum = 0;
    for (std::size_t i = 0; i < page.size(); ++i) {
        if (page.chart[i] == 0 || page.validity[i] < 1) continue;
        const double e = page.planes[layout.irradiance(1)][i], error = page.planes[layout.error()][i];
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
    BakeOptions options = small_options();
    options.samples = 512;
    const auto all = make(closed_box(), options);
    ASSERT_TRUE(all->run(Baker::Start::fresh, k_never));
    options.target_error = 0.05;
    const auto some = make(closed_box(), options);
    ASSERT_TRUE(some->run(Baker::Start::fresh, k_never));
    EXPECT_LT(some->statistics().rays, all->statistics().rays);
    EXPECT_LT(some->statistics().mean_error, 0.06);
}

TEST(Bake, StateKeepsToItsSize) {
    // 3 floats for each coefficient, a quarter more, and 16 bytes.
    for (const char* codec : {"sh1/moments/convolution", "sg12h/moments/exact", "sg12h/matrix-gain/exact"}) {
        BakeOptions options = small_options();
        options.codec = codec;
        const auto bake = make(closed_box(), options);
        const std::size_t floats = 3 * bake->codec()->basis().size();
        EXPECT_LE(static_cast<double>(bake->sites().bytes()), 1.25 * 4 * static_cast<double>(floats) + 16) << codec;
    }
}

}  // namespace
}  // namespace lobelia
