// Embedded scenes: valid, watertight where they should be, with charts that do not overlap.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "lobelia/sky.h"
#include "scene/chart_packer.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/world.h"

namespace lobelia {
namespace {

class EmbeddedScenes : public testing::TestWithParam<std::string_view> {
  protected:
    [[nodiscard]] static Scene scene() { return embedded_scene(GetParam()).value(); }
};

TEST_P(EmbeddedScenes, AreValid) {
    const Status status = check_scene(scene());
    EXPECT_TRUE(status) << status.error().message;
}

TEST_P(EmbeddedScenes, AreSmallAndLit) {
    const World world = make_world(scene());
    EXPECT_GE(world.triangles.size(), 12u);
    EXPECT_LE(world.triangles.size(), 12000u);
    EXPECT_FALSE(scene().cameras.empty());
    for (std::size_t t = 0; t < world.triangles.size(); ++t) EXPECT_GT(length(world.face_normal(t)), 0.5f) << t;
}

/// Smooth normals lie on the side of their triangle's front.
TEST_P(EmbeddedScenes, NormalsAgreeWithWinding) {
    const Scene scene = this->scene();
    const World world = make_world(scene);
    for (std::size_t t = 0; t < world.triangles.size(); ++t)
        for (const std::uint32_t v : world.triangles[t])
            EXPECT_GT(dot(world.normals[v], world.face_normal(t)), 0.3f) << scene.objects[world.object[t]].name;
}

/// Twice the area of a triangle in UV space, positive where it turns as x to y.
double area(Vec2 a, Vec2 b, Vec2 c) {
    return static_cast<double>(b.x - a.x) * static_cast<double>(c.y - a.y) -
           static_cast<double>(c.x - a.x) * static_cast<double>(b.y - a.y);
}

/// Texel centres of a fine grid are covered at most once, and by triangles of one turn.
TEST_P(EmbeddedScenes, LightmapUvsDoNotOverlap) {
    const World world = make_world(scene());
    constexpr int k_grid = 1024;
    std::vector<std::uint8_t> covered(k_grid * k_grid);
    std::size_t twice = 0, once = 0;
    for (const auto& triangle : world.triangles) {
        std::array<Vec2, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = world.lightmap_uv[triangle[k]];
            ASSERT_TRUE(p[k].x >= 0 && p[k].x <= 1 && p[k].y >= 0 && p[k].y <= 1);
            // An irrational shift, so that no centre lies on an edge.
            p[k] = {p[k].x * k_grid + 0.0137f, p[k].y * k_grid + 0.0071f};
        }
        ASSERT_GT(area(p[0], p[1], p[2]), 0);
        const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
        const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
        for (int y = static_cast<int>(y0); y <= static_cast<int>(y1) && y < k_grid; ++y)
            for (int x = static_cast<int>(x0); x <= static_cast<int>(x1) && x < k_grid; ++x) {
                const Vec2 c{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
                if (area(p[0], p[1], c) <= 0 || area(p[1], p[2], c) <= 0 || area(p[2], p[0], c) <= 0) continue;
                std::uint8_t& count = covered[static_cast<std::size_t>(y * k_grid + x)];
                once += count == 0;
                twice += count == 1;
                count = static_cast<std::uint8_t>(std::min(count + 1, 2));
            }
    }
    EXPECT_EQ(twice, 0u);
    EXPECT_GT(once, 0.5 * k_grid * k_grid);
}

INSTANTIATE_TEST_SUITE_P(All, EmbeddedScenes,
                         testing::ValuesIn(embedded_scene_names().begin(), embedded_scene_names().end()),
                         [](const auto& suite) {
                             std::string name(suite.param);
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(EmbeddedScene, UnknownNameListsTheNames) {
    const auto scene = embedded_scene("teapot");
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("cornell, cornell-closed, colonnade"), std::string::npos);
}

/// Edges by the positions of their ends; those of a closed room without its blocks and lamp are shared by two faces.
TEST(Cornell, ClosedRoomIsWatertight) {
    Scene scene = cornell_scene({.closed = true, .blocks = false});
    std::erase_if(scene.objects, [](const Object& o) { return o.name == "lamp"; });
    const World world = make_world(scene);
    std::map<std::array<float, 6>, int> edges;
    for (const auto& triangle : world.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = world.positions[triangle[k]], b = world.positions[triangle[(k + 1) % 3]];
            ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
            --edges[{b.x, b.y, b.z, a.x, a.y, a.z}];
        }
    for (const auto& [edge, count] : edges) EXPECT_EQ(count, 0);
    EXPECT_EQ(world.triangles.size(), 12u);
}

TEST(Colonnade, SunIsTheSkysSun) {
    const Scene scene = colonnade_scene();
    ASSERT_EQ(scene.lights.size(), 1u);
    const PunctualLight& sun = scene.lights[0];
    EXPECT_NEAR(sun.angular_radius, 0.2665 * k_pi / 180, 1e-7);
    EXPECT_LT(sun.direction.y, -0.4f);
    // Direct sunlight at that height is 300 to 900 W/m^2 of visible light by 179 lm/W.
    EXPECT_GT(luminance(sun.intensity), 200);
    EXPECT_LT(luminance(sun.intensity), 900);
    ASSERT_TRUE(scene.environment);
    for (const Rgb& p : scene.environment->pixels) EXPECT_LT(luminance(p), 1000);
}

TEST(ChartPacker, PlacesKeepTheirDistance) {
    std::vector<ChartSize> sizes;
    for (std::uint32_t i = 0; i < 40; ++i) sizes.push_back({1 + i * 7 % 23, 1 + i * 11 % 17});
    constexpr std::uint32_t k_side = 128, k_padding = 4;
    const auto places = pack_charts(sizes, k_side, k_padding);
    ASSERT_TRUE(places);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        EXPECT_LE((*places)[i].x + sizes[i].width, k_side - k_padding / 2);
        EXPECT_LE((*places)[i].y + sizes[i].height, k_side - k_padding / 2);
        for (std::size_t k = 0; k < i; ++k) {
            const bool apart_x = (*places)[i].x >= (*places)[k].x + sizes[k].width + k_padding ||
                                 (*places)[k].x >= (*places)[i].x + sizes[i].width + k_padding;
            const bool apart_y = (*places)[i].y >= (*places)[k].y + sizes[k].height + k_padding ||
                                 (*places)[k].y >= (*places)[i].y + sizes[i].height + k_padding;
            EXPECT_TRUE(apart_x || apart_y) << i << ' ' << k;
        }
    }
    EXPECT_FALSE(pack_charts(sizes, 32, k_padding));
}

/// Each fault is found where it is.
TEST(CheckScene, NamesTheFault) {
    const auto message = [](auto&& spoil) {
        Scene scene = cornell_scene();
        spoil(scene);
        const Status status = check_scene(scene);
        return status ? std::string("nothing") : status.error().message;
    };
    const auto starts = [](const std::string& text, std::string_view with) { return text.starts_with(with); };
    EXPECT_EQ(message([](Scene&) {}), "nothing");
    EXPECT_PRED2(starts, message([](Scene& s) { s.meshes[1].positions[2].y = NAN; }), "meshes[1].positions[2]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.meshes[1].triangles[1][0] = 99; }), "meshes[1].triangles[1]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.meshes[2].materials[0] = 99; }), "meshes[2].materials[0]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.meshes[2].normals.pop_back(); }), "meshes[2].normals");
    EXPECT_PRED2(starts, message([](Scene& s) { s.meshes[2].normals[1] = {0, 2, 0}; }), "meshes[2].normals[1]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.objects[3].mesh = 77; }), "objects[3]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.materials[1].base_color.g = 1.5f; }), "materials[1]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.materials[1].emission.b = INFINITY; }), "materials[1].emission");
    EXPECT_PRED2(starts, message([](Scene& s) { s.materials[0].base_color_texture = TextureUse{}; }),
                 "materials[0].base_color_texture");
    EXPECT_PRED2(starts, message([](Scene& s) { s.lights.emplace_back().kind = PunctualLight::Kind::directional; }),
                 "lights[0].direction");
    EXPECT_PRED2(starts, message([](Scene& s) { s.cameras[0].vertical_field_of_view = 0; }), "cameras[0]");
    EXPECT_PRED2(starts, message([](Scene& s) { s.environment = Image(2, 0); }), "environment");
}

}  // namespace
}  // namespace lobelia
