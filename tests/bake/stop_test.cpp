// Tests that a stop ends every stage of a bake: placing, finishing, packing, writing.
#include <gtest/gtest.h>

#include <atomic>

#include "bake/finish/find_seams.h"
#include "bake/finish/finish.h"
#include "bake/place/charts.h"
#include "bake/place/edges.h"
#include "bake/place/texels.h"
#include "bake/preflight/preflight.h"
#include "bake/session/setup.h"
#include "folders.h"
#include "lobelia/bake.h"
#include "lobelia/storage.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

BakeJob job_to_stop() {
    BakeJob job;
    job.bake.codec = "sh1/moments/convolution";
    job.bake.atlas.width = job.bake.atlas.height = 64;
    job.bake.samples = 16;
    job.bake.paths.bounces = 1;
    return job;
}

TEST(Stop, EveryStageLooksAtTheFlag) {
    const Scene scene = embedded_scene("cornell").value();
    const BakeJob job = job_to_stop();
    const auto made = BakeSetup::make(scene, job.bake);
    ASSERT_TRUE(made) << made.error().message;
    const BakeSetup& setup = **made;
    BakeSession session;
    auto baked = bake(scene, job, session);
    ASSERT_TRUE(baked) << baked.error().message;
    std::vector<LightmapPage>& pages = baked->pages;
    const PageChannels channels = baked->channels();
    const Guides guides = make_guides(setup.atlas, setup.map);
    const std::vector<double> integrals(channels.coefficients, 1);

    const std::atomic<bool> flag = true;
    const StopFlag stop = &flag;
    EXPECT_THROW((void)make_world(scene, stop), Stopped);
    EXPECT_THROW((void)Atlas::make(setup.world, job.bake.atlas, stop), Stopped);
    EXPECT_THROW((void)map_texels(setup.atlas, stop), Stopped);
    EXPECT_THROW((void)find_charts(setup.world, 0, stop), Stopped);
    EXPECT_THROW((void)weld_positions(setup.world, 0, stop), Stopped);
    EXPECT_THROW((void)displaced_texels(setup.atlas, setup.map, *setup.tracer, stop), Stopped);
    EXPECT_THROW(PathTracer(scene, setup.world, {}, stop), Stopped);
    EXPECT_THROW((void)BakeSetup::make(scene, job.bake, stop), Stopped);
    EXPECT_THROW((void)preflight(setup, 1, stop), Stopped);
    EXPECT_THROW((void)make_guides(setup.atlas, setup.map, stop), Stopped);
    EXPECT_THROW((void)find_seams(setup.atlas, 1e-4f, stop), Stopped);
    SeamOptions seams;
    seams.stop = stop;
    EXPECT_THROW(close_seams(pages, channels, setup.atlas, seams), Stopped);
    DenoiseOptions noise;
    noise.stop = stop;
    EXPECT_THROW(denoise(pages, channels, guides, integrals, 1, noise), Stopped);
    DilateOptions around;
    around.stop = stop;
    EXPECT_THROW(dilate(pages, around), Stopped);
    const Storage* storage = find_storage("float16").value();
    const CoefficientTraits traits{channels.coefficients, false, true, {}};
    const CoefficientPlanes planes(pages[0].width, pages[0].height, std::span(pages[0].planes), traits.count);
    const auto take = [](const auto&, const auto&) -> Status { return Done{}; };
    EXPECT_FALSE(pack_each(storage->layout(traits), planes, take, &flag));
}

TEST(Stop, ReachesTheCallerAsAnErrorAndLeavesNoFile) {
    const Scene scene = embedded_scene("cornell").value();
    const std::atomic<bool> flag = true;
    const test::TestFolder folder("bake-stop");
    BakeSession session{.folder = folder.path() / "bake", .stop = &flag};
    const auto baked = bake(scene, job_to_stop(), session);
    ASSERT_FALSE(baked);
    EXPECT_EQ(baked.error().message, "stopped");
    EXPECT_FALSE(preflight(scene, job_to_stop(), &flag));

    BakeSession whole;
    const auto bake_there = bake(scene, job_to_stop(), whole);
    ASSERT_TRUE(bake_there);
    const auto written = write_bake(folder.path() / "out", *bake_there, {.stop = &flag});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().message, "stopped");
    EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace lobelia
