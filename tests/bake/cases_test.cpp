// Small files with known answers: light is not mixed across walls, never negative, and stored as it is.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data.h"
#include "folders.h"
#include "lobelia/bake.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

/// Plain irradiance of a case, without denoising, as its README asks for it.
BakeJob plain_job() {
    BakeJob job;
    job.bake.codec.clear();
    job.bake.atlas.width = job.bake.atlas.height = 32;
    job.bake.samples = 64;
    job.finish.denoise = Switch::off;
    return job;
}

/// Bakes a file of the cases; returns nothing if it is not present.
std::optional<Bake> baked_case(const char* file, const BakeJob& job = plain_job()) {
    const fs::path path = test::cases_folder() / file;
    if (!fs::exists(path)) return std::nullopt;
    const auto loaded = load_scene({.path = path.string()});
    EXPECT_TRUE(loaded) << loaded.error().message;
    if (!loaded) return std::nullopt;
    BakeSession session;
    auto result = bake(loaded->scene, job, session);
    EXPECT_TRUE(result) << result.error().message;
    return result ? std::optional(*std::move(result)) : std::nullopt;
}

/// Calls visit(E, object) for each valid texel of the bake.
template <class Visit>
void for_each_texel(const Bake& bake, const Visit& visit) {
    const std::size_t plane = bake.channels().irradiance(1);
    for (const LightmapPage& page : bake.pages)
        for (std::size_t i = 0; i < page.size(); ++i)
            if (page.chart[i] != 0 && page.validity[i] >= 0.5f)
                visit(page.planes[plane][i], bake.preflight->object_of_chart[page.chart[i] - 1]);
}

/// Expects every texel of an object to hold this irradiance.
void expect_object(const Bake& bake, std::string_view name, float expected) {
    std::size_t texels = 0;
    for_each_texel(bake, [&](float e, std::uint32_t object) {
        if (bake.manifest.objects[object].name != name) return;
        EXPECT_NEAR(e, expected, 1e-3f * std::max(1.0f, expected)) << name;
        ++texels;
    });
    EXPECT_GT(texels, 100u) << name;
}

TEST(Cases, SeamsStayOpenUnderAPartition) {
    const auto bake = baked_case("s01-partition-on-seam.glb");
    if (!bake) GTEST_SKIP() << "no " << test::cases_folder();
    expect_object(*bake, "A", 0);
    expect_object(*bake, "B", 100);
}

TEST(Cases, SeamsStayOpenUnderAThickWall) {
    const auto bake = baked_case("s06-wall-0.1.glb");
    if (!bake) GTEST_SKIP() << "no " << test::cases_folder();
    expect_object(*bake, "floor A", 0);
    expect_object(*bake, "floor B", 100);
}

TEST(Cases, AClosedRoomBesideALitOneIsDark) {
    const auto bake = baked_case("s02-rooms-gap0.glb");
    if (!bake) GTEST_SKIP() << "no " << test::cases_folder();
    expect_object(*bake, "dark room", 0);
}

TEST(Cases, PlainIrradianceIsNeverNegative) {
    const auto bake = baked_case("s04-negative-E.glb");
    if (!bake) GTEST_SKIP() << "no " << test::cases_folder();
    for (const LightmapPage& page : bake->pages)
        for (std::size_t k = 0; k < 3; ++k)
            for (const float e : page.planes[bake->channels().irradiance(k)]) EXPECT_GE(e, 0);
}

TEST(Cases, PagesHoldWhatHalfFloatsCannot) {
    const test::TestFolder folder("cases-sun");
    const fs::path path = test::cases_folder() / "d04-sun-100000.glb";
    if (!fs::exists(path)) GTEST_SKIP() << "no " << test::cases_folder();
    const auto loaded = load_scene({.path = path.string()});
    ASSERT_TRUE(loaded) << loaded.error().message;
    BakeSession session;
    session.folder = folder.path();
    ASSERT_TRUE(bake(loaded->scene, plain_job(), session));
    const auto read = read_bake(folder.path());
    ASSERT_TRUE(read) << read.error().message;
    float largest = 0;
    for (const float e : read->pages[0].planes[read->channels().irradiance(1)]) largest = std::max(largest, e);
    EXPECT_NEAR(largest, 100000, 10);
    EXPECT_EQ(read->manifest.precision, Precision::full);
}

}  // namespace
}  // namespace lobelia
