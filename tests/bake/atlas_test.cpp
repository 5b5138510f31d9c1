// Tests layouts, charts and the texel map against exact clipping of every triangle with every texel.
#include "bake/place/atlas.h"

#include <random>
#include <set>

#include "scenes.h"
#include "support.h"
#include "threads.h"

namespace lobelia {
namespace {

using test::flat_triangles;
using test::parallelogram;
using test::scene_of;
using test::with_uv;
using ObjectLayout = AtlasOptions::Layout;

Atlas atlas_of(const World& world, const AtlasOptions& options = {}) {
    Result<Atlas> atlas = Atlas::make(world, options);
    EXPECT_TRUE(atlas) << atlas.error().message;
    return *std::move(atlas);
}

/// Area of a triangle clipped to a box, in long double: clips the list of corners by one half plane after another.
double exact_cover(const std::array<Vec2, 3>& triangle, int x, int y) {
    using Point = std::array<long double, 2>;
    std::vector<Point> polygon;
    for (const Vec2 p : triangle) polygon.push_back({p.x, p.y});
    for (const std::size_t axis : {0, 1})
        for (const int side : {-1, 1}) {
            const long double border = (axis == 0 ? x : y) + (side > 0 ? 1 : 0);
            const auto inside = [&](const Point& p) { return side > 0 ? border - p[axis] : p[axis] - border; };
            std::vector<Point> rest;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const long double ha = inside(a), hb = inside(b);
                if (ha >= 0) rest.push_back(a);
                if ((ha >= 0) != (hb >= 0))
                    rest.push_back({a[0] + (b[0] - a[0]) * ha / (ha - hb), a[1] + (b[1] - a[1]) * ha / (ha - hb)});
            }
            polygon = rest;
        }
    long double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return std::abs(static_cast<double>(twice)) / 2;
}

bool exact_contains(const std::array<Vec2, 3>& t, double x, double y) {
    int positive = 0, negative = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 a = t[i], b = t[(i + 1) % 3];
        const long double e = (static_cast<long double>(b.x) - a.x) * (y - static_cast<long double>(a.y)) -
                              (static_cast<long double>(b.y) - a.y) * (x - static_cast<long double>(a.x));
        positive += e > 0;
        negative += e < 0;
    }
    return positive == 0 || negative == 0;
}

std::vector<std::array<Vec2, 3>> random_triangles(std::size_t count, float size, std::uint32_t seed) {
    std::mt19937 generator(seed);
    const auto uniform = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(generator()) * 0x1p-32f;
    };
    std::vector<std::array<Vec2, 3>> result(count);
    for (auto& corners : result) {
        const Vec2 centre{uniform(-0.1f, 1.1f), uniform(-0.1f, 1.1f)};
        for (Vec2& p : corners) p = centre + Vec2{uniform(-size, size), uniform(-size, size)};
    }
    return result;
}

TEST(TexelMap, EqualsExactClippingOfEveryTriangle) {
    for (const float size : {0.01f, 0.1f, 0.7f}) {
        const World world = make_world(scene_of({flat_triangles(random_triangles(40, size, 3))}));
        const Atlas atlas = atlas_of(world, {.width = 70, .height = 45});
        const TexelMap map = map_texels(atlas);

        // Compute every texel's owner by the definition.
        std::vector<std::uint32_t> expected(70 * 45, Atlas::k_no_chart);
        std::vector<double> cover(expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const int x = static_cast<int>(i % 70), y = static_cast<int>(i / 70);
            for (std::uint32_t t = 0; t < 40 && expected[i] == Atlas::k_no_chart; ++t)
                if (exact_contains(atlas.texel_triangle(t), x + 0.5, y + 0.5)) expected[i] = t;
            if (expected[i] != Atlas::k_no_chart) continue;
            for (std::uint32_t t = 0; t < 40; ++t)
                if (const double area = exact_cover(atlas.texel_triangle(t), x, y);
                    area >= k_least_cover && area > cover[i]) {
                    cover[i] = area;
                    expected[i] = t;
                }
        }

        std::vector<std::uint32_t> found(expected.size(), Atlas::k_no_chart);
        for (std::size_t i = 0; i < map.texels.size(); ++i)
            found[map.texels[i].y * 70 + map.texels[i].x] = map.triangle[i];
        EXPECT_EQ(found, expected) << size;
    }
}

TEST(TexelMap, ComesInTheOrderOfTiles) {
    const World world = make_world(scene_of({flat_triangles(random_triangles(200, 0.05f, 5))}));
    const Atlas atlas = atlas_of(world, {.width = 130, .height = 97});
    const TexelMap map = map_texels(atlas);
    ASSERT_EQ(map.texels.size(), map.triangle.size());
    const auto rank = [&](const CoveredTexel& t) { return std::array<std::size_t, 3>{atlas.tile_of(t), t.y, t.x}; };
    std::set<std::uint32_t> firsts;
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        if (i == 0 || atlas.tile_of(map.texels[i]) != atlas.tile_of(map.texels[i - 1]))
            firsts.insert(static_cast<std::uint32_t>(i));
        if (i > 0) {
            EXPECT_LT(rank(map.texels[i - 1]), rank(map.texels[i]));
        }
    }
    firsts.insert(static_cast<std::uint32_t>(map.texels.size()));
    EXPECT_EQ(map.first_of_tile, std::vector<std::uint32_t>(firsts.begin(), firsts.end()));
}

TEST(TexelMap, IsTheSameAtAnyNumberOfThreads) {
    const World world = make_world(scene_of({flat_triangles(random_triangles(3000, 0.03f, 8))}));
    const Atlas atlas = atlas_of(world, {.width = 700, .height = 700});
    const auto run = [&](std::size_t threads) {
        return test::with_threads(threads, [&] { return map_texels(atlas); });
    };
    const TexelMap one = run(1), four = run(4);
    EXPECT_EQ(one.triangle, four.triangle);
    EXPECT_EQ(one.first_of_tile, four.first_of_tile);
}

TEST(TexelMap, FillsASquareWithoutGaps) {
    const World world = make_world(scene_of({test::height_field(37, [](float, float) { return 0.0f; })}));
    EXPECT_EQ(map_texels(atlas_of(world, {.width = 129, .height = 64})).texels.size(), 129u * 64u);
}

TEST(TexelMap, SurvivesUVsWithoutAreaAndFarOutside) {
    const float far = 3e38f;
    const World world = make_world(scene_of({flat_triangles({{Vec2{0.1f, 0.1f}, {0.5f, 0.5f}, {0.9f, 0.9f}},
                                                             {Vec2{0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}},
                                                             {Vec2{-far, -far}, {far, -far}, {0, far}},
                                                             {Vec2{far, far}, {far, far}, {far, -far}},
                                                             {Vec2{7, 7}, {8, 7}, {7, 8}}})}));
    for (const ObjectLayout layout : {ObjectLayout::shared, ObjectLayout::packed, ObjectLayout::automatic}) {
        const Atlas atlas = atlas_of(world, {.width = 64, .height = 64, .layout = layout});
        for (const std::uint32_t t : map_texels(atlas).triangle) EXPECT_EQ(t, 2u);
    }
}

TEST(TexelMap, RefusesUVsThatOverlapThousandsOfTimes) {
    std::vector<std::array<Vec2, 3>> triangles(3000, {Vec2{0, 0}, {2, 0}, {0, 2}});
    const World world = make_world(scene_of({flat_triangles(triangles)}));
    const auto atlas = Atlas::make(world, {.width = 4096, .height = 4096});
    ASSERT_FALSE(atlas);
    EXPECT_NE(atlas.error().message.find("lobelia unwrap"), std::string::npos);
}

TEST(Charts, AreWhatSharesPositionAndUV) {
    // Two triangles that share position and UV, and a third that shares only the UV.
    Mesh mesh = flat_triangles({{Vec2{0, 0}, {0.4f, 0}, {0, 0.4f}},
                                {Vec2{0.4f, 0}, {0.4f, 0.4f}, {0, 0.4f}},
                                {Vec2{0.4f, 0}, {0.8f, 0}, {0.4f, 0.4f}}});
    for (std::size_t v = 6; v < 9; ++v) mesh.positions[v].z = 1;
    const World world = make_world(scene_of({mesh, with_uv(mesh, 0.5f, {0.5f, 0.5f})}));
    const std::vector<std::uint32_t> expected{0, 0, 1, 2, 2, 3};
    EXPECT_EQ(atlas_of(world).chart_of_triangle(), expected);
}

TEST(Charts, DoNotJoinObjects) {
    const Mesh square = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const World world = make_world(scene_of({square, square}));
    const std::vector<std::uint32_t> expected{0, 0, 1, 1};
    EXPECT_EQ(atlas_of(world).chart_of_triangle(), expected);
}

TEST(Layouts, AreSharedUnlessObjectsOverlap) {
    const Mesh square = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    // Side by side, objects share at most a border; objects that overlap cannot share the UV square.
    const World apart = make_world(scene_of({with_uv(square, 0.5f, {0, 0}), with_uv(square, 0.5f, {0.5f, 0})}));
    const World same = make_world(scene_of({square, square}));
    EXPECT_EQ(atlas_of(apart).layout(), ObjectLayout::shared);
    EXPECT_EQ(atlas_of(same).layout(), ObjectLayout::packed);
    EXPECT_EQ(atlas_of(apart, {.layout = ObjectLayout::packed}).layout(), ObjectLayout::packed);
    EXPECT_EQ(atlas_of(apart, {.texels_per_metre = 10}).layout(), ObjectLayout::packed);
    EXPECT_EQ(atlas_of(same, {.layout = ObjectLayout::shared}).layout(), ObjectLayout::shared);
}

TEST(Layouts, SizeObjectsByArea) {
    // Squares of 1 m, 3 m and 4 m x 1 m; the last uses its UV square as a whole although it is not square.
    const World world = make_world(
        scene_of({parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), parallelogram({0, 0, 0}, {3, 0, 0}, {0, 3, 0}),
                  parallelogram({0, 0, 0}, {4, 0, 0}, {0, 1, 0})}));
    const Atlas atlas = atlas_of(world, {.width = 64, .height = 64, .texels_per_metre = 16});
    const double sides[] = {16, 48, 32};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(atlas.placements()[i].scale.x, sides[i], 1e-4);
        EXPECT_EQ(atlas.placements()[i].texels.x1 - atlas.placements()[i].texels.x0, sides[i]);
    }
    EXPECT_EQ(atlas.pages(), 2u);
}

TEST(Layouts, KeepPackedObjectsApart) {
    std::vector<Mesh> meshes;
    std::mt19937 generator(12);
    for (int i = 0; i < 60; ++i) {
        const float side = 0.2f + static_cast<float>(generator()) * 0x1p-32f;
        meshes.push_back(parallelogram({0, 0, 0}, {side, 0, 0}, {0, 2 * side, 0}, {0.1f, 0.2f}, {0.5f, 1}));
    }
    const World world = make_world(scene_of(std::move(meshes)));
    for (const std::optional<double> density : {std::optional<double>{}, std::optional<double>{20}}) {
        const AtlasOptions options{.width = 100, .height = 80, .texels_per_metre = density, .padding = 3};
        const Atlas atlas = atlas_of(world, options);
        EXPECT_EQ(atlas.layout(), ObjectLayout::packed);
        EXPECT_EQ(atlas.pages() == 1, !density);
        const auto& p = atlas.placements();
        for (std::size_t i = 0; i < p.size(); ++i) {
            EXPECT_TRUE(p[i].texels.x0 >= 0 && p[i].texels.y0 >= 0 && p[i].texels.x1 <= 100 && p[i].texels.y1 <= 80);
            for (std::size_t j = 0; j < i; ++j) {
                if (p[i].page != p[j].page) continue;
                const TexelBox& a = p[i].texels;
                const TexelBox near{p[j].texels.x0 - 3, p[j].texels.y0 - 3, p[j].texels.x1 + 3, p[j].texels.y1 + 3};
                EXPECT_TRUE(intersection(a, near).empty()) << i << ' ' << j;
            }
        }
        // Check that each triangle stays within its object's rectangle.
        const TexelMap map = map_texels(atlas);
        for (std::size_t i = 0; i < map.texels.size(); ++i) {
            const AtlasPlacement& own = p[world.object[map.triangle[i]]];
            const int x = static_cast<int>(map.texels[i].x), y = static_cast<int>(map.texels[i].y);
            EXPECT_EQ(own.page, map.texels[i].page);
            EXPECT_FALSE(intersection(own.texels, {x, y, x + 1, y + 1}).empty());
        }
    }
}

TEST(Layouts, FillMostOfAPage) {
    const Mesh square = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const World world = make_world(scene_of({square, square, square, square}));
    const TexelMap map = map_texels(atlas_of(world, {.width = 256, .height = 256}));
    EXPECT_GT(map.texels.size(), 256u * 256u * 95 / 100);
}

TEST(Layouts, NameWhatDoesNotFit) {
    const Mesh square = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    Mesh bare = square;
    bare.lightmap_uv.clear();
    const World world = make_world(scene_of({bare, square})), none = make_world(scene_of({bare}));
    const auto message = [](const World& w, const AtlasOptions& options) {
        const auto atlas = Atlas::make(w, options);
        return atlas ? std::string{} : atlas.error().message;
    };
    EXPECT_NE(message(world, {.texels_per_metre = 1000}).find("object 1"), std::string::npos);
    EXPECT_NE(message(none, {}).find("lobelia unwrap"), std::string::npos);
    World named = world;
    named.names = {"floor", "wall"};
    EXPECT_NE(message(named, {.texels_per_metre = 1000}).find("'wall' needs"), std::string::npos);
    EXPECT_NE(message(world, {.width = 0}), "");
    EXPECT_NE(message(world, {.width = 1u << 20}), "");
    EXPECT_NE(message(world, {.texels_per_metre = -1}), "");
    EXPECT_NE(message(world, {.texels_per_metre = NAN}), "");
    EXPECT_NE(message(world, {.texels_per_metre = 9, .layout = ObjectLayout::shared}), "");
    EXPECT_FALSE(atlas_of(world).placements()[0].baked);
    EXPECT_TRUE(atlas_of(world).placements()[1].baked);
}

}  // namespace
}  // namespace lobelia
