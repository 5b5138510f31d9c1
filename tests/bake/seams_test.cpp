// Tests the matching of edges and the closing of seams against searches over all pairs.
#include "bake/finish/finish.h"

#include <map>
#include <random>
#include <set>
#include <tuple>

#include "bake/place/split_edges.h"
#include "scenes.h"
#include "support.h"
#include "threads.h"

namespace lobelia {
namespace {

using test::parallelogram;
using test::scene_of;
using test::with_uv;

/// Pages of an atlas that hold value(world position) at the texels of `map`, on all channels.
template <class Value>
std::vector<LightmapPage> pages_with(const Atlas& atlas, const TexelMap& map, const PageChannels& layout,
                                     const Value& value) {
    std::vector<LightmapPage> pages(atlas.pages(), LightmapPage(atlas.width(), atlas.height(), layout.count()));
    const Guides guides = make_guides(atlas, map);
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        LightmapPage& page = pages[map.texels[i].page];
        const std::size_t place = map.texels[i].y * atlas.width() + map.texels[i].x;
        page.chart[place] = atlas.chart_of_triangle()[map.triangle[i]] + 1;
        page.validity[place] = 1;
        for (std::size_t c = 0; c < page.planes.size(); ++c)
            page.planes[c][place] =
                value(guides.position[map.texels[i].page][place], page.chart[place]) * static_cast<float>(c + 1);
    }
    return pages;
}

/// Filters bilinearly, as a renderer does.
float bilinear(const LightmapPage& page, std::size_t channel, Vec2 p) {
    float sum = 0;
    const float x = p.x - 0.5f, y = p.y - 0.5f;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const float px = std::floor(x) + static_cast<float>(dx), py = std::floor(y) + static_cast<float>(dy);
            const auto cx = static_cast<std::size_t>(std::clamp(px, 0.0f, static_cast<float>(page.width - 1)));
            const auto cy = static_cast<std::size_t>(std::clamp(py, 0.0f, static_cast<float>(page.height - 1)));
            sum += page.planes[channel][cy * page.width + cx] * (1 - std::abs(x - px)) * (1 - std::abs(y - py));
        }
    return sum;
}

/// Two squares side by side in the world, with charts of different sizes and turns.
struct TwoSquares {
    enum class Where { one_object, two_objects, two_pages };
    World world;
    Atlas atlas;
    explicit TwoSquares(Where where) : world(make(where)), atlas(*Atlas::make(world, options(where))) {}

    static World make(Where where) {
        Mesh left = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.05f, 0.05f}, {0.45f, 0.45f});
        Mesh right = parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0});
        // Rotated by a quarter turn: its left side is at the top of its chart.
        right.lightmap_uv = {{0.55f, 0.5f}, {0.55f, 0.93f}, {0.88f, 0.93f}, {0.88f, 0.5f}};
        if (where != Where::one_object) return make_world(scene_of({left, right}));
        for (std::size_t v = 0; v < 4; ++v) {
            left.positions.push_back(right.positions[v]);
            left.normals.push_back(right.normals[v]);
            left.lightmap_uv.push_back(right.lightmap_uv[v]);
        }
        left.triangles.push_back({4, 5, 6});
        left.triangles.push_back({4, 6, 7});
        left.materials.assign(4, 0);
        return make_world(scene_of({left}));
    }
    static AtlasOptions options(Where where) {
        AtlasOptions result{.width = 64, .height = 48};
        if (where == Where::two_pages) result.texels_per_metre = 40;
        return result;
    }
    [[nodiscard]] double largest_difference(std::span<const LightmapPage> pages, std::size_t channel) const {
        const auto left = atlas.texel_triangle(0), right = atlas.texel_triangle(3);
        double largest = 0;
        for (float s = 0.01f; s < 1; s += 0.01f) {
            const Vec2 a = left[1] * (1 - s) + left[2] * s, b = right[0] * (1 - s) + right[2] * s;
            largest = std::max<double>(largest, std::abs(bilinear(pages[atlas.page_of(0)], channel, a) -
                                                         bilinear(pages[atlas.page_of(3)], channel, b)));
        }
        return largest;
    }
};

constexpr std::array k_two_squares = {TwoSquares::Where::one_object, TwoSquares::Where::two_objects,
                                      TwoSquares::Where::two_pages};

/// Smooth light, with a tenth more on one side.
float uneven_light(Vec3 p, std::uint32_t chart) { return (1 + p.y * p.y) * (chart == 1 ? 1.0f : 1.1f); }

TEST(Seams, Close) {
    const PageChannels layout{1};
    for (const auto where : k_two_squares) {
        const TwoSquares squares(where);
        const TexelMap map = map_texels(squares.atlas);
        ASSERT_EQ(squares.atlas.pages(), where == TwoSquares::Where::two_pages ? 2u : 1u);
        const auto before = pages_with(squares.atlas, map, layout, uneven_light);
        auto after = before;
        const SeamReport report = close_seams(after, layout, squares.atlas);
        EXPECT_EQ(report.edges, 1u);
        EXPECT_LT(report.after, 0.1 * report.before);
        for (std::size_t p = 0; p < after.size(); ++p)
            EXPECT_EQ(after[p].planes[layout.error()], before[p].planes[layout.error()]);

        // Compare as a renderer filters, with the gutter filled.
        auto dilated_before = before, dilated_after = after;
        dilate(dilated_before);
        dilate(dilated_after);
        for (std::size_t c = 0; c < layout.error(); ++c)
            EXPECT_LT(squares.largest_difference(dilated_after, c),
                      0.2 * squares.largest_difference(dilated_before, c));
    }
}

TEST(Seams, LeaveFarTexelsAlone) {
    const PageChannels layout{1};
    const TwoSquares squares(TwoSquares::Where::two_objects);
    const TexelMap map = map_texels(squares.atlas);
    const auto before = pages_with(squares.atlas, map, layout, uneven_light);
    auto after = before;
    close_seams(after, layout, squares.atlas);
    const Guides guides = make_guides(squares.atlas, map);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < before[0].size(); ++i) {
        const bool near = before[0].chart[i] != 0 && std::abs(guides.position[0][i].x - 1) < 2.5f / 20;
        changed += after[0].planes[0][i] != before[0].planes[0][i];
        if (!near) {
            EXPECT_EQ(after[0].planes[0][i], before[0].planes[0][i]);
        }
        // Check that no value leaves the previous range.
        EXPECT_LE(after[0].planes[0][i], 2.3f);
        EXPECT_GE(after[0].planes[0][i], 0.0f);
    }
    EXPECT_GT(changed, 20u);
}

TEST(Seams, LeaveWhatAgrees) {
    const PageChannels layout{1};
    for (const auto where : k_two_squares) {
        const TwoSquares squares(where);
        const TexelMap map = map_texels(squares.atlas);
        const auto before = pages_with(squares.atlas, map, layout, [](Vec3, std::uint32_t) { return 0.7f; });
        auto after = before;
        const SeamReport report = close_seams(after, layout, squares.atlas);
        EXPECT_LT(report.before, 1e-6);
        for (std::size_t p = 0; p < after.size(); ++p)
            for (std::size_t i = 0; i < after[p].size(); ++i)
                ASSERT_NEAR(after[p].planes[0][i], before[p].planes[0][i], 1e-6f);
    }
}

/// The two squares, with a wall without thickness on their common edge.
struct WalledSquares {
    Scene scene = test::scene_of({parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.05f, 0.05f}, {0.45f, 0.45f}),
                                  parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.55f, 0.5f}, {0.95f, 0.9f}),
                                  test::without_lightmap(parallelogram({1, 0, 0}, {0, 1, 0}, {0, 0, 0.3f}))});
    World world = make_world(scene);
    Atlas atlas = *Atlas::make(world, {.width = 64, .height = 64});
    TexelMap map = map_texels(atlas);
    PathTracer tracer{scene, world};
};

TEST(Seams, StayOpenUnderWalls) {
    const PageChannels layout{1};
    const WalledSquares squares;
    const auto before = pages_with(squares.atlas, squares.map, layout, uneven_light);
    auto through = before, walled = before;
    close_seams(through, layout, squares.atlas);
    close_seams(walled, layout, squares.atlas, {}, {&squares.tracer, {}});
    EXPECT_NE(through[0].planes, before[0].planes);
    EXPECT_EQ(walled[0].planes, before[0].planes);
}

TEST(Seams, OfOpenSurfacesCloseAsWithoutATracer) {
    // On a plane, and around the smooth edge of a hill, nothing stands on the seams.
    Mesh hill = test::height_field(6, [](float x, float y) { return 0.3f * std::sin(3 * x) * std::sin(3 * y); });
    for (const Scene& scene : {scene_of({with_uv(hill, 0.45f, {0, 0})}), WalledSquares().scene}) {
        Scene open = scene;
        if (open.objects.size() == 3) open.objects.pop_back();
        const World world = make_world(open);
        const Atlas atlas = *Atlas::make(world, {.width = 64, .height = 64});
        const PathTracer tracer(open, world);
        const PageChannels layout{1};
        const auto before = pages_with(atlas, map_texels(atlas), layout, uneven_light);
        auto plain = before, looked = before;
        close_seams(plain, layout, atlas);
        close_seams(looked, layout, atlas, {}, {&tracer, {}});
        EXPECT_EQ(plain[0].planes, looked[0].planes);
    }
}

TEST(Seams, DisplacedTexelsTakeNoPart) {
    const PageChannels layout{1};
    const WalledSquares squares;
    const auto before = pages_with(squares.atlas, squares.map, layout, uneven_light);
    std::vector<std::uint8_t> displaced(before[0].size());
    const Guides guides = make_guides(squares.atlas, squares.map);
    for (std::size_t i = 0; i < displaced.size(); ++i)
        displaced[i] = before[0].chart[i] != 0 && std::abs(guides.position[0][i].x - 1) < 0.1f;
    auto after = before;
    close_seams(after, layout, squares.atlas, {}, {nullptr, {displaced}});
    for (std::size_t i = 0; i < displaced.size(); ++i)
        if (displaced[i] != 0) {
            EXPECT_EQ(after[0].planes[0][i], before[0].planes[0][i]);
        }
}

TEST(Seams, KeepToTheRangeOfWhatTheyJoin) {
    // Random light of 0 or 100 makes least squares overshoot.
    const PageChannels layout{1};
    const TwoSquares squares(TwoSquares::Where::two_objects);
    std::mt19937 generator(4);
    const auto before = pages_with(squares.atlas, map_texels(squares.atlas), layout,
                                   [&](Vec3, std::uint32_t) { return generator() % 2 == 0 ? 0.0f : 100.0f; });
    auto after = before;
    close_seams(after, layout, squares.atlas);
    EXPECT_NE(after[0].planes, before[0].planes);
    for (std::size_t c = 0; c < layout.error(); ++c)
        for (const float value : after[0].planes[c]) {
            EXPECT_GE(value, 0);
            EXPECT_LE(value, 100 * static_cast<float>(c + 1));
        }
}

TEST(Seams, WithinOneChartCloseToo) {
    // The wall of a tube is one chart whose left and right ends meet.
    constexpr std::uint32_t k_sides = 24;
    Mesh tube;
    for (std::uint32_t i = 0; i <= k_sides; ++i)
        for (const float z : {0.0f, 1.0f}) {
            const float s = static_cast<float>(i) / k_sides, a = static_cast<float>(2 * k_pi) * s;
            tube.positions.push_back({std::cos(a), std::sin(a), z});
            tube.normals.push_back({std::cos(a), std::sin(a), 0});
            tube.lightmap_uv.push_back({0.1f + 0.8f * s, 0.2f + 0.5f * z});
        }
    for (std::uint32_t i = 0; i < k_sides; ++i) {
        tube.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        tube.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    tube.materials.assign(tube.triangles.size(), 0);
    const World world = make_world(scene_of({tube}));
    const Atlas atlas = *Atlas::make(world, {.width = 100, .height = 40});
    const TexelMap map = map_texels(atlas);
    EXPECT_EQ(*std::max_element(atlas.chart_of_triangle().begin(), atlas.chart_of_triangle().end()), 0u);
    const PageChannels layout{1};
    // Brightness grows around the tube, to half as much again at the end.
    auto pages = pages_with(atlas, map, layout, [](Vec3 p, std::uint32_t) {
        const float a = std::atan2(p.y, p.x);
        return 1 + (a < 0 ? a + static_cast<float>(2 * k_pi) : a) / 12;
    });
    const SeamReport report = close_seams(pages, layout, atlas);
    EXPECT_EQ(report.edges, 1u);
    EXPECT_LT(report.after, 0.1 * report.before);
}

/// A square beside two half squares: no edge on the left matches one on the right from end to end.
TEST(Seams, CloseAtTJunctions) {
    const Mesh left = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.05f, 0.05f}, {0.45f, 0.45f});
    const Mesh lower = parallelogram({1, 0, 0}, {1, 0, 0}, {0, 0.5f, 0}, {0.55f, 0.05f}, {0.95f, 0.25f});
    const Mesh upper = parallelogram({1, 0.5f, 0}, {1, 0, 0}, {0, 0.5f, 0}, {0.55f, 0.35f}, {0.95f, 0.55f});
    const World world = make_world(scene_of({left, lower, upper}));
    const Atlas atlas = *Atlas::make(world, {.width = 64, .height = 64});
    const PageChannels layout{1};
    auto pages = pages_with(atlas, map_texels(atlas), layout, uneven_light);
    const SeamReport report = close_seams(pages, layout, atlas);
    EXPECT_EQ(report.edges, 3u);  // the halves of the long edge, and the edge between the two on the right
    EXPECT_LT(report.after, 0.1 * report.before);
}

TEST(Seams, StopAtCreasesAndUnbakedObjects) {
    const PageChannels layout{1};
    const Mesh floor = parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0}, {0.4f, 0.4f});
    const Mesh wall = parallelogram({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0.5f, 0.5f}, {0.9f, 0.9f});
    Mesh bare = parallelogram({1, 0, 0}, {1, 0, 0}, {0, 1, 0});
    bare.lightmap_uv.clear();
    const World world = make_world(scene_of({floor, wall, bare}));
    const Atlas atlas = *Atlas::make(world, {.width = 32, .height = 32});
    auto pages = pages_with(atlas, map_texels(atlas), layout, uneven_light);
    const auto before = pages;
    EXPECT_EQ(close_seams(pages, layout, atlas).edges, 0u);
    EXPECT_EQ(pages[0].planes, before[0].planes);
}

TEST(Seams, AreTheSameAtAnyNumberOfThreads) {
    const PageChannels layout{4};
    const TwoSquares squares(TwoSquares::Where::two_objects);
    const TexelMap map = map_texels(squares.atlas);
    const auto run = [&](std::size_t threads) {
        auto pages = pages_with(squares.atlas, map, layout, uneven_light);
        test::with_threads(threads, [&] { return close_seams(pages, layout, squares.atlas).edges; });
        return pages[0].planes;
    };
    EXPECT_EQ(run(1), run(4));
}

// ---- Edges

TEST(Edges, WeldEqualsTheSearchOfAllPairs) {
    // Clusters whose members lie within the tolerance of each other, and clusters apart.
    World world;
    std::mt19937 generator(4);
    const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
    constexpr float k_near = 1e-3f;
    std::vector<std::size_t> cluster;
    for (std::size_t c = 0; c < 60; ++c) {
        const Vec3 centre{std::floor(10 * uniform()), std::floor(10 * uniform()), static_cast<float>(c)};
        for (int i = 0; i < 5; ++i) {
            world.positions.push_back(centre + Vec3{uniform(), uniform(), uniform()} * (k_near / 2));
            cluster.push_back(c);
        }
    }
    const auto welded = weld_positions(world, k_near);
    for (std::size_t i = 0; i < cluster.size(); ++i)
        for (std::size_t j = 0; j < cluster.size(); ++j) EXPECT_EQ(welded[i] == welded[j], cluster[i] == cluster[j]);
}

TEST(Edges, SplitEqualsTheSearchOfAllPairs) {
    // Loose edges on a small lattice: many end within others.
    World world;
    std::mt19937 generator(9);
    std::vector<EdgePiece> pieces;
    const auto lattice = [&] { return static_cast<float>(generator() % 4); };
    for (std::uint32_t x = 0; x < 64; ++x)
        world.positions.push_back(
            {static_cast<float>(x % 4), static_cast<float>(x / 4 % 4), static_cast<float>(x / 16)});
    const auto vertex = [&] { return static_cast<std::uint32_t>(lattice() + 4 * lattice() + 16 * lattice()); };
    for (std::uint32_t t = 0; t < 150; ++t) {
        const std::uint32_t a = vertex(), b = vertex();
        if (a != b) pieces.push_back({std::min(a, b), std::max(a, b), t, 0, 0, 1});
    }
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> found, wanted;
    for (const EdgePiece& piece : split_edges(world, pieces, 1e-3f)) {
        EXPECT_LT(piece.low, piece.high);
        found.insert({piece.triangle, piece.low, piece.high});
    }
    for (const EdgePiece& piece : pieces) {
        const Vec3 a = world.positions[piece.low], d = world.positions[piece.high] - a;
        std::map<float, std::uint32_t> on{{0.0f, piece.low}, {1.0f, piece.high}};
        for (const EdgePiece& other : pieces)
            for (const std::uint32_t v : {other.low, other.high}) {
                const Vec3 p = world.positions[v] - a;
                const float s = dot(p, d) / dot(d, d);
                if (s > 0.01f && s < 0.99f && length(p - d * s) < 1e-3f) on[std::round(s * 1000) / 1000] = v;
            }
        for (auto at = on.begin(); std::next(at) != on.end(); ++at)
            wanted.insert({piece.triangle, std::min(at->second, std::next(at)->second),
                           std::max(at->second, std::next(at)->second)});
    }
    EXPECT_GT(found.size(), pieces.size() + 10);
    EXPECT_EQ(found, wanted);
}

}  // namespace
}  // namespace lobelia
