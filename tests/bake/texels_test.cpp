// Tests the sample points of texels: on the surface, within the texel, and not inside overlapping geometry.
#include "bake/place/texels.h"

#include <algorithm>

#include "scenes.h"
#include "small_scenes.h"
#include "support.h"

namespace lobelia {
namespace {

using test::parallelogram;

/// A scene made ready, and all its texels.
struct Baked {
    Scene scene;
    World world = make_world(scene);
    Atlas atlas;
    TexelMap map = map_texels(atlas);
    PathTracer tracer{scene, world};

    Baked(Scene s, const AtlasOptions& options) : scene(std::move(s)), atlas(*Atlas::make(world, options)) {}
    [[nodiscard]] std::vector<Receiver> texels(Switch push_out) const {
        std::vector<Receiver> result;
        make_receivers(atlas, map, 0, map.texels.size(), tracer, push_out, result);
        return result;
    }
};

/// The floor z = 0 from -1 to 1, seen from above, on a page of 20 x 20 texels (a tenth of a metre each).
Scene floor_scene() {
    Scene scene;
    scene.materials.emplace_back();
    test::add_object(scene, parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    return scene;
}
constexpr std::size_t k_side = 20;
constexpr float k_texel = 0.1f;

Mesh box(Vec3 low, Vec3 high, test::Facing facing = test::Facing::outwards) {
    Mesh mesh;
    test::add_box(mesh, 0, low, high, facing);
    return mesh;
}

Baked floor_with(std::vector<Mesh> meshes) {
    Scene scene = floor_scene();
    for (Mesh& mesh : meshes) test::add_object(scene, std::move(mesh));
    return {std::move(scene), {.width = k_side, .height = k_side}};
}

/// Provides light only.
Mesh unbaked(Mesh mesh) {
    mesh.lightmap_uv.clear();
    return mesh;
}

TEST(Texels, LieOnTheSurfaceInTheirTexel) {
    // UVs are the world's x and y, so that positions identify texels.
    const auto hill = [](float x, float y) { return 0.2f * std::sin(5 * x) * std::cos(4 * y); };
    Scene scene;
    scene.materials.emplace_back();
    test::add_object(scene, test::height_field(7, hill));
    const Baked baked(std::move(scene), {.width = 50, .height = 40});
    const auto texels = baked.texels(Switch::off);
    ASSERT_EQ(texels.size(), 50u * 40u);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const CoveredTexel& at = baked.map.texels[i];
        const Receiver& texel = texels[i];
        const Vec3 centre = surface_of(baked.atlas, baked.map, i).position;
        const Vec3 face = baked.world.face_normal(baked.map.triangle[i]);
        EXPECT_NEAR(centre.x * 50, static_cast<float>(at.x) + 0.5f, 1e-4f);
        EXPECT_NEAR(centre.y * 40, static_cast<float>(at.y) + 0.5f, 1e-4f);
        EXPECT_NEAR(length(texel.normal), 1, 1e-5f);
        EXPECT_GT(dot(texel.normal, face), 0.8f);
        EXPECT_FALSE(texel.moved);
        ASSERT_EQ(texel.position_count, k_most_positions);
        for (std::size_t k = 0; k < k_most_positions; ++k) {
            // Check that points lie off the surface, but not far.
            const Vec3 p = texel.positions[k];
            EXPECT_EQ(std::floor(p.x * 50 + 1e-3f * (centre.x - p.x)), static_cast<float>(at.x));
            EXPECT_EQ(std::floor(p.y * 40 + 1e-3f * (centre.y - p.y)), static_cast<float>(at.y));
            PathTracer::Hit hit;
            const PathTracer::Ray down{p, {0, 0, -1}, 1};
            baked.tracer.closest({&down, 1}, {&hit, 1});
            EXPECT_LT(hit.distance, 1e-4f);
            EXPECT_FALSE(hit.back_face);
            for (std::size_t j = 0; j < k; ++j) EXPECT_GT(length(p - texel.positions[j]), 0.4f / 50);
        }
    }
}

TEST(Texels, AreTheSameInAnyRange) {
    Scene scene;
    scene.materials.emplace_back();
    test::add_object(scene, test::height_field(9, [](float x, float y) { return 0.3f * x * y; }));
    test::add_object(scene, box({0.2f, 0.3f, -0.1f}, {0.6f, 0.4f, 0.5f}));
    const Baked baked(std::move(scene), {.width = 75, .height = 75});
    const auto all = baked.texels(Switch::on);
    std::vector<Receiver> part;
    for (const std::size_t step : {1, 7, 1000})
        for (std::size_t begin = 0; begin < all.size(); begin += step) {
            const std::size_t end = std::min(begin + step, all.size());
            make_receivers(baked.atlas, baked.map, begin, end, baked.tracer, Switch::on, part);
            ASSERT_EQ(part.size(), end - begin);
            for (std::size_t i = begin; i < end; ++i) {
                ASSERT_EQ(part[i - begin].positions, all[i].positions);
                ASSERT_EQ(part[i - begin].position_count, all[i].position_count);
                ASSERT_EQ(part[i - begin].normal, all[i].normal);
                ASSERT_EQ(part[i - begin].buried, all[i].buried);
            }
        }
}

TEST(Texels, UseWhatTheirChartCovers) {
    // A thin sliver that holds no centre and no point of the pattern, and a triangle beside it of another chart.
    Scene scene;
    scene.materials.emplace_back();
    test::add_object(scene, test::flat_triangles({{Vec2{0.0f, 0.51f}, {1.0f, 0.51f}, {1.0f, 0.515f}}}));
    const Baked baked(std::move(scene), {.width = 10, .height = 10});
    const auto texels = baked.texels(Switch::off);
    ASSERT_FALSE(texels.empty());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const Receiver& texel = texels[i];
        const Vec3 centre = surface_of(baked.atlas, baked.map, i).position;
        EXPECT_EQ(texel.position_count, 1u);
        EXPECT_GE(centre.y, 0.51f - 1e-6f);
        EXPECT_LE(centre.y, 0.515f + 1e-6f);
        EXPECT_GT(texel.positions[0].y, 0.51f);
        EXPECT_LT(texel.positions[0].y, 0.515f);
    }
}

TEST(Texels, StandOnTheirFrontInMirroredObjects) {
    Scene scene = floor_scene();
    scene.objects[0].world_from_object.rows[0] = {-1, 0, 0};
    const Baked baked(std::move(scene), {.width = k_side, .height = k_side});
    for (const Receiver& texel : baked.texels(Switch::on)) {
        EXPECT_GT(texel.positions[0].z, 0);
        EXPECT_EQ(texel.normal, (Vec3{0, 0, 1}));
    }
}

float largest_difference(const Rotation& a, const Rotation& b) {
    float largest = 0;
    for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, length(a[i] - b[i]));
    return largest;
}

TEST(TangentFrame, IsARotationToTheNormal) {
    const Directions normals = test::random_directions(Domain::sphere, 20000, 3);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3 n = direction_at(normals, i);
        const auto& [x, y, z] = tangent_from_world(n);
        EXPECT_EQ(z, n);
        EXPECT_NEAR(dot(x, x), 1, 1e-4f);
        EXPECT_NEAR(dot(y, y), 1, 1e-4f);
        EXPECT_NEAR(dot(x, y), 0, 1e-4f);
        EXPECT_LT(length(cross(x, y) - n), 1e-4f);
    }
    const Rotation at_pole = tangent_from_world({-2.0f / 7, -3.0f / 7, -6.0f / 7});
    EXPECT_LT(length(cross(at_pole[0], at_pole[1]) - at_pole[2]), 1e-5f);
}

TEST(TangentFrame, TurnsAsSlowlyAsTheNormal) {
    // The faces, edges and corners of a cube, and random directions of the sphere, without the pole itself.
    std::vector<Vec3> normals;
    for (int i = 0; i < 27; ++i)
        if (i != 13)
            normals.push_back(normalize(
                Vec3{static_cast<float>(i % 3 - 1), static_cast<float>(i / 3 % 3 - 1), static_cast<float>(i / 9 - 1)}));
    const Directions everywhere = test::random_directions(Domain::sphere, 2000, 4);
    const Directions steps = test::random_directions(Domain::sphere, 2000, 5);
    for (std::size_t i = 0; i < everywhere.size(); ++i) normals.push_back(direction_at(everywhere, i));
    constexpr float k_step = 1e-3f;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const float cosine = dot(normals[i], Vec3{-2.0f / 7, -3.0f / 7, -6.0f / 7});
        if (cosine > 0.98f) continue;
        const Vec3 next = normalize(normals[i] + direction_at(steps, i % steps.size()) * k_step);
        // The frame turns about the normal by tan(half the angle from Z) for each unit that the normal moves.
        const float turn = std::sqrt((1 + cosine) / (1 - cosine));
        EXPECT_LT(largest_difference(tangent_from_world(normals[i]), tangent_from_world(next)),
                  k_step * (1.1f + 1.1f * turn));
    }
    EXPECT_EQ(tangent_from_world({1, 0, 0.0f})[0], tangent_from_world({1, 0, -0.0f})[0]);
}

TEST(PushOut, LeavesAnOpenFloorAlone) {
    const Baked baked = floor_with({});
    const auto off = baked.texels(Switch::off), on = baked.texels(Switch::on);
    for (std::size_t i = 0; i < off.size(); ++i) {
        EXPECT_EQ(off[i].positions, on[i].positions);
        EXPECT_FALSE(on[i].buried);
    }
}

TEST(PushOut, MovesFloorUnderTheRimOfABox) {
    // The box stands on the floor; its sides run through the middle of texels.
    const float side = 0.45f;
    for (const float bottom : {0.0f, -0.2f}) {
        const Baked baked = floor_with({box({-side, -side, bottom}, {side, side, 1})});
        const auto off = baked.texels(Switch::off), on = baked.texels(Switch::on);
        std::size_t moved = 0, buried = 0;
        for (std::size_t i = 0; i < on.size(); ++i) {
            const Vec3 centre = surface_of(baked.atlas, baked.map, i).position;
            const auto depth_of = [&](Vec3 p) { return side - std::max(std::abs(p.x), std::abs(p.y)); };
            buried += on[i].buried;
            for (std::size_t k = 0; k < on[i].position_count && !on[i].buried; ++k) {
                EXPECT_LT(depth_of(on[i].positions[k]), 0) << centre.x << ' ' << centre.y;
                EXPECT_NEAR(on[i].positions[k].z, off[i].positions[k].z, 1e-7f);
            }
            for (std::size_t k = 0; k < on[i].position_count && on[i].position_count == off[i].position_count; ++k) {
                // Points take the shortest way out, within the angle between two search directions, and move at most
                // one texel.
                const Vec3 before = off[i].positions[k], after = on[i].positions[k];
                const float depth = depth_of(before), way = length(after - before);
                if (on[i].buried || depth < 0) {
                    EXPECT_EQ(way, 0);
                } else {
                    EXPECT_LT(way, std::min(1.1f * depth, k_texel) + 1e-4f);
                    EXPECT_TRUE(on[i].moved);
                    ++moved;
                }
            }
            // Points deeper than a texel stay buried.
            EXPECT_EQ(on[i].buried, depth_of(centre) > 1.2f * k_texel);
        }
        EXPECT_GT(moved, 50u);
        EXPECT_EQ(buried, 36u);
    }
}

TEST(PushOut, StepsUpOntoWhatLiesFlat) {
    // A sheet that faces up, a hundredth of a texel above the floor, with no edge near.
    const Baked baked = floor_with({unbaked(parallelogram({-0.55f, -0.55f, 0.001f}, {1.1f, 0, 0}, {0, 1.1f, 0}))});
    for (const Receiver& texel : baked.texels(Switch::on)) {
        EXPECT_FALSE(texel.buried);
        for (std::size_t k = 0; k < texel.position_count; ++k) {
            const Vec3 p = texel.positions[k];
            EXPECT_EQ(p.z > 0.001f, std::max(std::abs(p.x), std::abs(p.y)) < 0.55f);
        }
    }
}

TEST(PushOut, PassesThroughNoWall) {
    // Two rooms share a floor. Their walls are planes that face into each room, in one plane or closer together than a
    // texel. Points that are free in one room stay in it.
    for (const float gap : {1e-2f, 1e-4f, 1e-5f, 0.0f}) {
        const Mesh right = unbaked(parallelogram({gap / 2, -2, -1}, {0, 4, 0}, {0, 0, 3}));
        const Mesh left = unbaked(parallelogram({-gap / 2, -2, -1}, {0, 0, 3}, {0, 4, 0}));
        const Baked baked = floor_with({right, left});
        const auto off = baked.texels(Switch::off), on = baked.texels(Switch::on);
        for (std::size_t i = 0; i < on.size(); ++i)
            for (std::size_t k = 0; k < off[i].position_count; ++k)
                EXPECT_EQ(on[i].positions[k], off[i].positions[k]) << gap;
    }
}

TEST(PushOut, StopsBetweenAWallAndWhatIsRightBehindIt) {
    // Points move out of the box, but not into the wall that it nearly touches, a two-sided sheet.
    Scene scene = floor_scene();
    scene.materials.emplace_back().double_sided = true;
    test::add_object(scene, box({-0.45f, -0.45f, 0}, {0.45f, 0.45f, 1}));
    const float sheet = 0.45f + 2e-6f;
    Mesh wall = unbaked(parallelogram({sheet, -2, -1}, {0, 4, 0}, {0, 0, 3}));
    wall.materials = {1, 1};
    test::add_object(scene, wall);
    const Baked baked(std::move(scene), {.width = k_side, .height = k_side});
    const auto off = baked.texels(Switch::off), on = baked.texels(Switch::on);
    for (std::size_t i = 0; i < on.size(); ++i)
        for (std::size_t k = 0; k < on[i].position_count && on[i].position_count == off[i].position_count; ++k)
            EXPECT_EQ(off[i].positions[k].x < sheet, on[i].positions[k].x < sheet);
}

TEST(PushOut, GoesThroughObjectsWithinObjects) {
    // Two boxes overlap: the way out of one leads into the other.
    const Baked baked =
        floor_with({box({-0.45f, -0.45f, 0}, {0.45f, 0.45f, 1}), box({0.41f, -0.45f, 0}, {0.5f, 0.45f, 1})});
    const auto off = baked.texels(Switch::off), on = baked.texels(Switch::on);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < on.size(); ++i)
        for (std::size_t k = 0; k < on[i].position_count; ++k) {
            const Vec3 before = off[i].positions[k], after = on[i].positions[k];
            if (std::abs(before.y) > 0.3f || before.x < 0.42f || before.x > 0.5f) continue;
            EXPECT_GT(after.x, 0.5f) << before.x;
            ++moved;
        }
    EXPECT_GT(moved, 5u);
}

TEST(PushOut, LiftsWallsOutOfTheFloor) {
    // A wall reaches a third of a texel below the floor; points beneath it move up.
    Scene scene = floor_scene();
    scene.meshes[0].lightmap_uv.clear();
    test::add_object(scene, parallelogram({0, -1, -0.0333f}, {0, 2, 0}, {0, 0, 2}));
    const Baked baked(std::move(scene), {.width = k_side, .height = k_side});
    std::size_t low = 0;
    const auto off = baked.texels(Switch::off), on = baked.texels(Switch::on);
    for (std::size_t i = 0; i < on.size(); ++i) {
        EXPECT_FALSE(on[i].buried);
        for (std::size_t k = 0; k < on[i].position_count; ++k) {
            EXPECT_GT(on[i].positions[k].z, 0);
            EXPECT_NEAR(on[i].positions[k].x, off[i].positions[k].x, 1e-8f);
            low += off[i].positions[k].z < 0;
        }
    }
    EXPECT_GT(low, 5u);
}

}  // namespace
}  // namespace lobelia
