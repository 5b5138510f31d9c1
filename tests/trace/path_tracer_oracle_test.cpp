// Tests the path tracer against its plain oracle in small random scenes with all kinds of lights and materials,
// textures, transparency, one-sided and smooth surfaces.
#include <gtest/gtest.h>

#include "measure.h"
#include "plain_path_tracer.h"
#include "support.h"

namespace lobelia {
namespace {

/// Random numbers for making scenes.
class Chance {
  public:
    explicit Chance(std::uint32_t seed) : generator_(seed) {}
    float in(float low, float high) {
        return low + (high - low) * static_cast<float>(static_cast<double>(generator_()) * 0x1p-32);
    }
    bool one_in(std::uint32_t n) { return generator_() % n == 0; }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(generator_()) % n; }
    Vec3 point(float reach) { return {in(-reach, reach), in(-reach, reach), in(-reach, reach)}; }
    Rgb color(float low, float high) { return {in(low, high), in(low, high), in(low, high)}; }

  private:
    std::mt19937 generator_;
};

TextureUse random_use(Scene& scene, Chance& chance) {
    Texture t;
    t.width = 1 + chance.below(5);
    t.height = 1 + chance.below(5);
    for (std::size_t i = 0; i < t.width * t.height; ++i) {
        auto& texel = t.texels.emplace_back();
        for (auto& channel : texel) channel = static_cast<std::uint8_t>(chance.below(256));
    }
    scene.textures.push_back(std::move(t));
    TextureUse use;
    use.texture = scene.textures.size() - 1;
    use.uv_from_mesh = {{{chance.in(0.5f, 2), chance.in(-1, 1), chance.in(0, 1)}, {chance.in(-1, 1), 1, 0.25f}}};
    return use;
}

Material random_material(Scene& scene, Chance& chance) {
    Material m;
    m.base_color = chance.color(0.2f, 0.9f);
    m.double_sided = chance.one_in(2);
    if (chance.one_in(3)) {
        m.specular = 0;
    } else {
        // Not too smooth: the oracle finds highlights by chance only.
        m.roughness = chance.in(0.5f, 1);
        m.metallic = chance.one_in(2) ? chance.in(0, 1) : 0.0f;
        m.ior = chance.in(1.2f, 2.2f);
        m.specular = chance.in(0, 1);
        m.specular_color = chance.color(0.3f, 1);
    }
    if (chance.one_in(3)) m.base_color_texture = random_use(scene, chance);
    if (chance.one_in(4)) {
        m.metallic_roughness_texture = random_use(scene, chance);
        for (auto& texel : scene.textures.back().texels) texel[1] = static_cast<std::uint8_t>(180 + chance.below(76));
    }
    if (chance.one_in(3)) {
        m.alpha_mode = chance.one_in(2) ? Material::Alpha::mask : Material::Alpha::blend;
        m.alpha = chance.in(0.3f, 1);
    }
    if (chance.one_in(3)) {
        m.emission = chance.color(0.2f, 2);
        if (chance.one_in(2)) m.emissive_texture = random_use(scene, chance);
    }
    return m;
}

void add_lights(Scene& scene, Chance& chance) {
    if (!chance.one_in(3)) {
        Image sky(8, 4);
        for (Rgb& c : sky.pixels) c = chance.color(0, 2);
        scene.environment = sky;
    }
    if (chance.one_in(2)) {
        PunctualLight light;
        light.kind = chance.one_in(2) ? PunctualLight::Kind::point : PunctualLight::Kind::spot;
        light.intensity = chance.color(0.2f, 1);
        light.position = {chance.in(-0.3f, 0.3f), chance.in(0.5f, 0.9f), chance.in(-0.3f, 0.3f)};
        light.direction = normalize(Vec3{chance.in(-0.3f, 0.3f), -1, 0});
        light.inner_angle = 0.4f;
        light.outer_angle = 1.2f;
        light.range = chance.one_in(2) ? 5.0f : 0.0f;
        scene.lights.push_back(light);
    }
    if (chance.one_in(2)) {
        PunctualLight sun;
        sun.kind = PunctualLight::Kind::directional;
        sun.direction = normalize(Vec3{chance.in(-1, 1), -1, chance.in(-1, 1)});
        sun.intensity = chance.color(0.5f, 2);
        sun.angular_radius = chance.one_in(2) ? 0.4f : 0.0f;
        scene.lights.push_back(sun);
    }
}

/// A box without a side or two, free triangles, quads with colours at their vertices, a smooth ball; lights.
Scene random_lit_scene(std::uint32_t seed) {
    Scene scene;
    Chance chance(seed);
    for (int i = 0; i < 6; ++i) scene.materials.push_back(random_material(scene, chance));
    scene.materials.push_back(test::matte({0.5f, 0.6f, 0.7f}));
    Mesh mesh;
    test::add_box(mesh, 6, {-1, -1, -1}, {1, 1, 1}, test::Facing::inwards);
    // The floor (triangles 4 and 5) keeps its material; the others get random ones, and one triangle is removed.
    for (std::size_t t = 6; t < mesh.triangles.size(); ++t) mesh.materials[t] = chance.below(7);
    mesh.triangles.resize(mesh.triangles.size() - 2 * chance.below(2));
    mesh.materials.resize(mesh.triangles.size());
    for (int i = 0; i < 3; ++i) {
        const Vec3 x = normalize(chance.point(1)), y = normalize(cross(x, chance.point(1)));
        test::add_square(mesh, chance.below(6), chance.point(0.5f), x, y, chance.in(0.1f, 0.5f));
    }
    test::add_object(scene, mesh);

    Mesh coloured;
    test::add_square(coloured, chance.below(6), chance.point(0.5f), {0, 0, 1}, {1, 0, 0}, 0.4f);
    for (int i = 0; i < 4; ++i)
        coloured.colors.push_back({chance.in(0, 1), chance.in(0, 1), chance.in(0, 1), chance.in(0.3f, 1)});
    test::add_object(scene, coloured, {test::some_rotation(), {0.1f, 0.1f, 0}});

    Mesh ball = test::make_sphere(chance.below(6), 1, test::Normals::smooth);
    for (const Vec3 p : ball.positions) ball.uv[0].push_back({p.x, p.y});
    test::add_object(scene, ball, test::scaled(0.25f, chance.point(0.5f)));
    add_lights(scene, chance);
    return scene;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LOBELIA_SLOW 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LOBELIA_SLOW 1
#endif
#endif
#ifdef LOBELIA_SLOW
constexpr int k_plain_paths = 1500;
#else
constexpr int k_plain_paths = 30000;
#endif

TEST(PathTracerOracle, AgreesInRandomScenes) {
    constexpr std::uint32_t scenes = 20;
    constexpr int bounces = 3;
    for (std::uint32_t seed = 1; seed <= scenes; ++seed) {
        const Scene scene = random_lit_scene(seed);
        const World world = make_world(scene);
        Chance chance(seed + 100);
        const Vec3 on_floor{chance.in(-0.9f, 0.9f), -1, chance.in(-0.9f, 0.9f)};
        test::PlainPathTracer plain(scene, bounces, seed);
        std::array<test::Estimate, 3> truth;
        for (int i = 0; i < k_plain_paths; ++i) {
            const test::Vec3d e = plain.irradiance({on_floor.x, on_floor.y + 1e-6, on_floor.z}, {0, 1, 0});
            truth[0].add(e.x), truth[1].add(e.y), truth[2].add(e.z);
        }
        const PathTracer tracer(scene, world, {.bounces = bounces});
        const auto found = test::measure(tracer, on_floor, {0, 1, 0},
                                         {.directions = DirectionChoice::mixture, .keys = 64, .samples = 256});
        // Welch's t of 60 comparisons, 1e-3 for all together (Bonferroni): |t| < 4.3 with so many samples.
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_LT(deviation(found.channels[k], truth[k]), 4.3)
                << "scene " << seed << ": " << found.channels[k].mean() << " and " << truth[k].mean() << " +- "
                << truth[k].standard_error();
    }
}

}  // namespace
}  // namespace lobelia
