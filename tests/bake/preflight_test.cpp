// Tests that preflight reports exactly the faults that a scene was given, and nothing else.
#include "bake/preflight/preflight.h"

#include <map>
#include <numeric>

#include "scenes.h"
#include "small_scenes.h"
#include "support.h"

namespace lobelia {
namespace {

using test::flat_triangles;
using test::parallelogram;
using test::scene_of;
using test::with_uv;

struct Checked {
    Scene scene;
    World world = make_world(scene);
    Atlas atlas;
    TexelMap map = map_texels(atlas);
    Preflight found;

    Checked(Scene s, const AtlasOptions& options, const PreflightOptions& preflight_options = {})
        : scene(std::move(s)), atlas(*Atlas::make(world, options)), found(preflight(atlas, map, preflight_options)) {}
    [[nodiscard]] bool warns_of(const std::string& text) const {
        const auto all = warnings(found, scene);
        return std::any_of(all.begin(), all.end(),
                           [&](const std::string& w) { return w.find(text) != std::string::npos; });
    }
};

Mesh square_at(float x, float y, float side) {
    return parallelogram({x, y, 0}, {side, 0, 0}, {0, side, 0}, {x, y}, {x + side, y + side});
}

constexpr AtlasOptions shared_page(std::size_t side) {
    AtlasOptions options;
    options.width = options.height = side;
    options.layout = AtlasOptions::Layout::shared;
    return options;
}

TEST(Preflight, FindsNothingWhereAllIsWell) {
    const Checked checked(scene_of({square_at(0, 0, 0.4f), square_at(0.5f, 0.5f, 0.5f)}), shared_page(100));
    EXPECT_TRUE(warnings(checked.found, checked.scene).empty()) << warnings(checked.found, checked.scene)[0];
    EXPECT_EQ(checked.found.texels, 1600u + 2500u);
    EXPECT_EQ(checked.found.charts, 2u);
    EXPECT_EQ(checked.found.pages.size(), 1u);
    EXPECT_NEAR(checked.found.density.least, 100, 1e-2);
    EXPECT_NEAR(checked.found.density.median, 100, 1e-2);
    EXPECT_NEAR(checked.found.density.most, 100, 1e-2);
    EXPECT_FALSE(checked.found.seconds);
    EXPECT_EQ(checked.found.objects[1].texels, 2500u);
    EXPECT_NEAR(checked.found.objects[1].texels_per_metre, 100, 1e-2);
}

TEST(Preflight, CountsOverlapsBetweenObjects) {
    // Two objects overlap in 10 x 40 texels; a third lies apart.
    const Checked checked(scene_of({square_at(0, 0, 0.4f), square_at(0.3f, 0, 0.4f), square_at(0.8f, 0.8f, 0.2f)}),
                          shared_page(100));
    ASSERT_EQ(checked.found.overlaps.size(), 1u);
    EXPECT_EQ(checked.found.overlaps[0].object, 0u);
    EXPECT_EQ(checked.found.overlaps[0].other, 1u);
    EXPECT_EQ(checked.found.overlaps[0].texels, 400u);
    EXPECT_EQ(checked.found.objects[0].overlapping_texels, 400u);
    EXPECT_EQ(checked.found.objects[2].overlapping_texels, 0u);
    EXPECT_TRUE(checked.warns_of("object 0 and object 1 overlap on 400 texels"));
    const auto& marks = checked.found.pages[0].mark;
    EXPECT_EQ(std::count(marks.begin(), marks.end(), TexelMark::overlap), 400);
}

TEST(Preflight, CountsOverlapsWithinAnObject) {
    // The second triangle is folded back over the first: one chart, half of it twice.
    const Checked checked(
        scene_of({flat_triangles({{Vec2{0, 0}, {0.8f, 0}, {0, 0.8f}}, {Vec2{0.8f, 0}, {0, 0}, {0, 0.8f}}})}),
        shared_page(50));
    ASSERT_EQ(checked.found.overlaps.size(), 1u);
    EXPECT_EQ(checked.found.overlaps[0].object, checked.found.overlaps[0].other);
    EXPECT_NEAR(static_cast<double>(checked.found.overlaps[0].texels), 0.5 * 40 * 40, 25);
    EXPECT_EQ(checked.found.charts, 1u);
    EXPECT_TRUE(checked.warns_of("overlap each other"));
}

TEST(Preflight, DoesNotTakeSharedEdgesForOverlaps) {
    const Checked checked(scene_of({test::height_field(23, [](float x, float) { return x; })}), shared_page(64));
    EXPECT_TRUE(warnings(checked.found, checked.scene).empty());
    EXPECT_EQ(checked.found.texels, 64u * 64u);
}

TEST(Preflight, MeasuresThePaddingBetweenCharts) {
    // Squares of 20 texels with 0 to 3 free columns between.
    for (std::size_t free = 0; free <= 3; ++free) {
        const float right = 0.2f + 0.01f * static_cast<float>(free);
        const Checked checked(scene_of({square_at(0, 0, 0.2f), square_at(right, 0, 0.2f)}), shared_page(100));
        if (free >= 2) {
            EXPECT_FALSE(checked.found.least_padding);
            EXPECT_TRUE(warnings(checked.found, checked.scene).empty());
        } else {
            ASSERT_TRUE(checked.found.least_padding);
            EXPECT_EQ(*checked.found.least_padding, free);
            // On each side, the columns with fewer than two free columns beside them.
            EXPECT_EQ(checked.found.objects[0].tight_texels, (2 - free) * 20);
            EXPECT_EQ(checked.found.objects[1].tight_texels, (2 - free) * 20);
        }
    }
}

TEST(Preflight, FindsUVsOutside) {
    const Checked checked(scene_of({with_uv(square_at(0, 0, 0.5f), 1, {0.7f, 0}), square_at(0, 0.6f, 0.2f)}),
                          shared_page(32));
    EXPECT_EQ(checked.found.objects[0].outside_triangles, 2u);
    EXPECT_EQ(checked.found.objects[1].outside_triangles, 0u);
    EXPECT_TRUE(checked.warns_of("outside [0, 1]"));
}

TEST(Preflight, FindsBadTriangles) {
    Mesh mesh = square_at(0, 0, 0.5f);
    // A triangle without area in the world, one without area on the page, and a third at an edge that has two.
    const auto add = [&](std::array<Vec3, 3> p, std::array<Vec2, 3> uv) {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::size_t i = 0; i < 3; ++i) {
            mesh.positions.push_back(p[i]);
            mesh.normals.push_back({0, 0, 1});
            mesh.lightmap_uv.push_back(uv[i]);
        }
        mesh.triangles.push_back({base, base + 1, base + 2});
        mesh.materials.push_back(0);
    };
    add({Vec3{3, 0, 0}, {4, 0, 0}, {5, 0, 0}}, {Vec2{0.7f, 0.7f}, {0.8f, 0.7f}, {0.7f, 0.8f}});
    add({Vec3{3, 1, 0}, {4, 1, 0}, {4, 2, 0}}, {Vec2{0.9f, 0.9f}, {0.9f, 0.9f}, {0.9f, 0.9f}});
    add({mesh.positions[0], mesh.positions[2], {0, 0, 1}}, {Vec2{0.6f, 0.1f}, {0.9f, 0.1f}, {0.6f, 0.4f}});
    const Checked checked(scene_of({mesh}), shared_page(100));
    EXPECT_EQ(checked.found.objects[0].degenerate_triangles, 1u);
    EXPECT_EQ(checked.found.objects[0].unmapped_triangles, 1u);
    EXPECT_EQ(checked.found.objects[0].non_manifold_edges, 1u);
    EXPECT_TRUE(checked.warns_of("1 degenerate triangle (1 of"));
    EXPECT_TRUE(checked.warns_of("1 triangle without area on the page (1 of"));
    EXPECT_TRUE(checked.warns_of("1 edge shared by three or more triangles (1 of"));
}

TEST(Preflight, NamesObjectsWithoutUVs) {
    Mesh bare = square_at(0, 0, 1);
    bare.lightmap_uv.clear();
    Scene scene = scene_of({square_at(0, 0, 1), bare});
    scene.objects[1].name = "curtain";
    const Checked checked(std::move(scene), shared_page(32));
    EXPECT_TRUE(checked.warns_of("1 object without lightmap UVs ('curtain')"));
    EXPECT_EQ(warnings(checked.found, checked.scene).size(), 1u);
}

/// A scene may contain thousands of such objects.
TEST(Preflight, SaysOnceHowManyHaveNoUVs) {
    Scene scene = scene_of({square_at(0, 0, 1)});
    scene.meshes.push_back(square_at(0, 0, 1));
    scene.meshes[1].lightmap_uv.clear();
    for (int i = 0; i < 100; ++i) scene.objects.push_back({"post", 1, {}});
    const Checked checked(std::move(scene), shared_page(32));
    EXPECT_TRUE(checked.warns_of("100 objects without lightmap UVs ('post', 'post', 'post', 'post' and 96 more)"));
    EXPECT_EQ(warnings(checked.found, checked.scene).size(), 1u);
}

TEST(Preflight, WeighsDensityByArea) {
    // Nine tenths of the area at 10 texels per metre, one tenth at 80.
    const Mesh wide = parallelogram({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0}, {0.3f, 0.3f});
    const Mesh dense = parallelogram({5, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2f, 0.35f}, {1, 1});
    const Checked checked(scene_of({wide, with_uv(dense, 1, {0, 0})}), shared_page(100));
    EXPECT_NEAR(checked.found.density.least, 10, 1e-3);
    EXPECT_NEAR(checked.found.density.median, 10, 1e-3);
    EXPECT_NEAR(checked.found.density.most, std::sqrt(80.0 * 65.0), 1e-2);
    const auto& share = checked.found.density.share;
    EXPECT_NEAR(share.front(), 0.9, 1e-5);
    EXPECT_NEAR(share.back(), 0.1, 1e-5);
    EXPECT_LE(checked.found.density.first, 10);
    EXPECT_GT(checked.found.density.first * std::sqrt(2), 10);
    EXPECT_NEAR(std::accumulate(share.begin(), share.end(), 0.0), 1, 1e-9);
}

TEST(Preflight, AddsUpMemoryAndTime) {
    const PreflightOptions options{
        .padding = 2, .state_bytes = 100, .channels = 16, .samples = 64, .rate = RayRate{1e6, 10}};
    const Checked checked(scene_of({square_at(0, 0, 0.5f)}), shared_page(64), options);
    EXPECT_EQ(checked.found.memory.states, 32u * 32u * 100u);
    EXPECT_EQ(checked.found.memory.pages, 64u * 64u * (16u * 4u + 8u));
    EXPECT_EQ(checked.found.memory.texels, 32u * 32u * 16u);
    ASSERT_TRUE(checked.found.seconds);
    EXPECT_NEAR(*checked.found.seconds, 32 * 32 * 64 * 10 / 1e6, 1e-9);
    const std::string text = to_text(checked.found, checked.scene);
    EXPECT_NE(text.find("1 page of 64 x 64 texels, 1024 covered (25.0 %), 1 chart"), std::string::npos) << text;
    EXPECT_NE(text.find("memory: "), std::string::npos);
    EXPECT_NE(text.find("time: about 1 s"), std::string::npos);
}

TEST(Preflight, MeasuresARate) {
    const Checked checked(scene_of({square_at(0, 0, 0.5f)}), shared_page(64));
    const PathTracer tracer(checked.scene, checked.world);
    const RayRate rate = measure_rate(checked.atlas, checked.map, tracer);
    EXPECT_GT(rate.rays_per_second, 1e3);
    EXPECT_GE(rate.rays_per_sample, 1);
    EXPECT_LT(rate.rays_per_sample, 20);
}

TEST(Preflight, DrawsWhatItFound) {
    const Checked checked(scene_of({square_at(0, 0, 0.4f), square_at(0.3f, 0, 0.4f), square_at(0.71f, 0, 0.2f)}),
                          shared_page(100));
    using Pixel = std::array<int, 3>;
    const auto colours = [](const Image8& picture) {
        std::map<Pixel, std::size_t> counts;
        for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
            ++counts[{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]}];
        return counts;
    };
    const Image8 whole = preflight_picture(checked.found, 0);
    EXPECT_EQ(whole.width, 100u);
    auto counts = colours(whole);
    // Colours of three charts, of empty texels, of overlaps and of tight padding.
    EXPECT_EQ(counts.size(), 6u);
    EXPECT_EQ((counts[{230, 20, 20}]), 400u);
    EXPECT_EQ((counts[{255, 150, 0}]), checked.found.objects[1].tight_texels + checked.found.objects[0].tight_texels +
                                           checked.found.objects[2].tight_texels);
    // A reduced picture still shows the most severe status.
    const Image8 small = preflight_picture(checked.found, 0, 30);
    EXPECT_EQ(small.width, 25u);
    EXPECT_EQ(small.rgb.size(), 25u * 25u * 3u);
    EXPECT_GE((colours(small)[{230, 20, 20}]), 25u);
}

TEST(Preflight, SurvivesHostileUVs) {
    const float far = 3e38f;
    const Checked checked(scene_of({flat_triangles({{Vec2{-far, -far}, {far, -far}, {0, far}},
                                                    {Vec2{far, far}, {far, far}, {far, -far}},
                                                    {Vec2{0, 0}, {0, 0}, {0, 0}}})}),
                          shared_page(40));
    EXPECT_FALSE(to_text(checked.found, checked.scene).empty());
}

}  // namespace
}  // namespace lobelia
