// Tests probes: each measures the furnace's light, none stays inside walls, the same bits at any number of threads.
#include <gtest/gtest.h>

#include <tbb/task_arena.h>

#include <cmath>

#include "bake/probes/bake_probes.h"
#include "small_scenes.h"

namespace lobelia {
namespace {

constexpr float k_room_albedo = 0.5f, k_room_emission = 0.75f;

/// A closed room of 2 x 2 x 2 m whose walls all emit.
Scene glowing_room() {
    Scene scene;
    scene.materials.push_back(test::matte({k_room_albedo, k_room_albedo, k_room_albedo},
                                          {k_room_emission, k_room_emission, k_room_emission}));
    Mesh room;
    test::add_box(room, 0, {-1, -1, -1}, {1, 1, 1}, test::Facing::inwards);
    test::add_object(scene, std::move(room));
    return scene;
}

ProbeSet probes_of(const Scene& scene, const ProbeOptions& options, unsigned threads = 0) {
    const World world = make_world(scene);
    PathOptions paths;
    paths.bounces = 32;
    const PathTracer tracer(scene, world, paths);
    tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
    auto probes = arena.execute([&] { return bake_probes(tracer, options); });
    EXPECT_TRUE(probes) << probes.error().message;
    return *std::move(probes);
}

/// Cells of 1.3 m about a room of 2 m: the outer probes lie 0.3 m behind one wall, at edges and corners behind two and
/// three. All must move into the room, or interpolation would darken it.
TEST(Probes, OfAGridAboutARoomComeIn) {
    ProbeOptions options;
    options.spacing = 1.3;
    options.samples = 64;
    options.codec = "sh1/moments/convolution";
    const ProbeSet probes = probes_of(glowing_room(), options);
    ASSERT_EQ(probes.size(), 27u);
    ASSERT_TRUE(probes.grid);
    EXPECT_FLOAT_EQ(probes.grid->origin.x, -1.3f);
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const Vec3 p = probes.positions[i];
        EXPECT_LT(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1) << i;
        EXPECT_EQ(probes.validity[i], 1) << i;
    }
}

TEST(Probes, WhiteFurnace) {
    ProbeOptions options;
    options.spacing = 1;
    options.box = {{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}};
    options.samples = 4096;
    options.codec = "sh1/moments/convolution";
    const ProbeSet probes = probes_of(glowing_room(), options);
    ASSERT_EQ(probes.size(), 8u);
    const double radiance = static_cast<double>(k_room_emission) / (1 - static_cast<double>(k_room_albedo));
    for (std::size_t i = 0; i < probes.size(); ++i) {
        // The light is the same from all directions; Russian roulette is the only noise.
        const double found = static_cast<double>(probes.coefficients[4 * i].g) / std::sqrt(4 * k_pi);
        EXPECT_NEAR(found, radiance, 0.02 * radiance);
        for (std::size_t k = 1; k < 4; ++k)
            EXPECT_NEAR(static_cast<double>(probes.coefficients[4 * i + k].g), 0, 0.1 * radiance);
    }
}

TEST(Probes, SameBitsAtAnyNumberOfThreads) {
    ProbeOptions options;
    options.spacing = 1;
    options.levels = 1;
    options.samples = 64;
    const Scene scene = glowing_room();
    const ProbeSet one = probes_of(scene, options, 1), four = probes_of(scene, options, 4);
    EXPECT_EQ(one.positions, four.positions);
    EXPECT_EQ(one.coefficients, four.coefficients);
    EXPECT_EQ(one.validity, four.validity);
}

}  // namespace
}  // namespace lobelia
