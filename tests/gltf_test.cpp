// glTF: what is written is read back; every kind of content is read as it should be; bad files are refused with a
// place.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <set>

#include "gltf_files.h"
#include "io/read_picture.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/gltf_read.h"
#include "scene/gltf_write.h"
#include "scene/world.h"

namespace lobelia {
namespace {

using nlohmann::json;

Result<LoadedScene> read(const std::string& bytes, const GltfReadOptions& options = {}) {
    return read_gltf(std::as_bytes(std::span(bytes)), "test.glb", {}, options);
}

/// The scene, or a failed test.
Scene scene_of(const GltfFile& file, const GltfReadOptions& options = {}) {
    auto text = read(file.gltf(), options), binary = read(file.glb(), options);
    EXPECT_TRUE(text) << text.error().message;
    EXPECT_TRUE(binary) << binary.error().message;
    return text ? text->scene : Scene{};
}

std::string error_of(const std::string& bytes, const GltfReadOptions& options = {}) {
    const auto result = read(bytes, options);
    return result ? "read without an error" : result.error().message;
}

testing::AssertionResult has(const std::string& text, std::string_view part) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "\"" << text << "\" lacks \"" << part << "\"";
}

// ---------------------------------------------------------------------------------------------- round trip

void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-6f) { EXPECT_LE(length(a - b), tolerance); }

void expect_same(const Transform& a, const Transform& b) {
    for (std::size_t i = 0; i < 3; ++i) expect_near(a.rows[i], b.rows[i]);
    EXPECT_EQ(a.translation, b.translation);
}

void expect_same(const std::optional<TextureUse>& a, const std::optional<TextureUse>& b) {
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) return;
    EXPECT_EQ(a->texture, b->texture);
    EXPECT_EQ(a->uv_set, b->uv_set);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(a->uv_from_mesh[i / 3][i % 3], b->uv_from_mesh[i / 3][i % 3], 1e-6f);
}

void expect_same(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.positions, b.positions);
    ASSERT_EQ(a.normals.size(), b.normals.size());
    for (std::size_t i = 0; i < a.normals.size(); ++i) expect_near(a.normals[i], b.normals[i]);
    EXPECT_EQ(a.uv[0], b.uv[0]);
    EXPECT_EQ(a.uv[1], b.uv[1]);
    EXPECT_EQ(a.lightmap_uv, b.lightmap_uv);
    EXPECT_EQ(a.colors, b.colors);
    // Triangles keep their order within a material.
    const auto sorted = [](const Mesh& mesh) {
        std::vector<std::pair<std::uint32_t, std::array<std::uint32_t, 3>>> list;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) list.emplace_back(mesh.materials[t], mesh.triangles[t]);
        std::stable_sort(list.begin(), list.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
        return list;
    };
    EXPECT_EQ(sorted(a), sorted(b));
}

void expect_same(const Material& a, const Material& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.base_color, b.base_color);
    EXPECT_EQ(a.alpha, b.alpha);
    EXPECT_EQ(a.metallic, b.metallic);
    EXPECT_EQ(a.roughness, b.roughness);
    EXPECT_NEAR(a.emission.r, b.emission.r, 1e-6f * a.emission.r);
    EXPECT_NEAR(a.emission.g, b.emission.g, 1e-6f * a.emission.g);
    EXPECT_NEAR(a.emission.b, b.emission.b, 1e-6f * a.emission.b);
    EXPECT_EQ(a.alpha_mode, b.alpha_mode);
    if (a.alpha_mode == Material::Alpha::mask) {
        EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
    }
    EXPECT_EQ(a.double_sided, b.double_sided);
    EXPECT_EQ(a.unlit, b.unlit);
    EXPECT_EQ(a.ior, b.ior);
    EXPECT_EQ(a.specular, b.specular);
    EXPECT_EQ(a.specular_color, b.specular_color);
    expect_same(a.base_color_texture, b.base_color_texture);
    expect_same(a.metallic_roughness_texture, b.metallic_roughness_texture);
    expect_same(a.emissive_texture, b.emissive_texture);
}

void expect_same(const PunctualLight& a, const PunctualLight& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_NEAR(a.intensity.r, b.intensity.r, 1e-6f * a.intensity.r);
    EXPECT_NEAR(a.intensity.g, b.intensity.g, 1e-6f * a.intensity.g);
    EXPECT_NEAR(a.intensity.b, b.intensity.b, 1e-6f * a.intensity.b);
    EXPECT_EQ(a.position, b.position);
    expect_near(a.direction, b.direction);
    EXPECT_EQ(a.inner_angle, b.inner_angle);
    EXPECT_EQ(a.outer_angle, b.outer_angle);
    EXPECT_EQ(a.angular_radius, b.angular_radius);
    EXPECT_EQ(a.range, b.range);
}

void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.name, b.name);
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) expect_same(a.meshes[i], b.meshes[i]);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
        EXPECT_EQ(a.objects[i].name, b.objects[i].name);
        EXPECT_EQ(a.objects[i].mesh, b.objects[i].mesh);
        expect_same(a.objects[i].world_from_object, b.objects[i].world_from_object);
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) expect_same(a.materials[i], b.materials[i]);
    ASSERT_EQ(a.textures.size(), b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i) {
        EXPECT_EQ(a.textures[i].name, b.textures[i].name);
        EXPECT_EQ(a.textures[i].texels, b.textures[i].texels);
        EXPECT_EQ(a.textures[i].width, b.textures[i].width);
        EXPECT_EQ(a.textures[i].wrap_u, b.textures[i].wrap_u);
        EXPECT_EQ(a.textures[i].wrap_v, b.textures[i].wrap_v);
    }
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) expect_same(a.lights[i], b.lights[i]);
    ASSERT_EQ(a.cameras.size(), b.cameras.size());
    for (std::size_t i = 0; i < a.cameras.size(); ++i) {
        EXPECT_EQ(a.cameras[i].name, b.cameras[i].name);
        EXPECT_EQ(a.cameras[i].vertical_field_of_view, b.cameras[i].vertical_field_of_view);
        expect_same(a.cameras[i].world_from_camera, b.cameras[i].world_from_camera);
    }
}

Scene written_and_read(const Scene& scene, const GltfWriteOptions& options = {}) {
    const auto bytes = encode_glb(scene, options);
    EXPECT_TRUE(bytes) << bytes.error().message;
    auto loaded = read(*bytes);
    EXPECT_TRUE(loaded) << loaded.error().message;
    for (const std::string& warning : loaded->warnings) ADD_FAILURE() << warning;
    return std::move(loaded->scene);
}

TEST(RoundTrip, EmbeddedScenes) {
    for (const std::string_view name : embedded_scene_names()) {
        const Scene scene = embedded_scene(name).value();
        expect_same(scene, written_and_read(scene));
    }
}

/// A scene with a bit of everything that the model has; all else random.
Scene random_scene(std::uint32_t seed) {
    std::mt19937 generator(seed);
    const auto number = [&] { return static_cast<float>(generator() % 4096) / 4096; };
    const auto point = [&] { return Vec3{10 * number() - 5, 10 * number() - 5, 10 * number() - 5}; };
    const auto pick = [&](std::size_t count) { return generator() % count; };
    Scene scene;
    scene.name = "random";
    for (std::size_t i = 0; i < 3; ++i) {
        Texture& texture = scene.textures.emplace_back();
        texture.name = "texture " + std::to_string(i);
        texture.width = 1 + pick(7);
        texture.height = 1 + pick(7);
        for (std::size_t k = 0; k < texture.width * texture.height; ++k)
            texture.texels.push_back({static_cast<std::uint8_t>(pick(256)), static_cast<std::uint8_t>(pick(256)),
                                      static_cast<std::uint8_t>(pick(256)), static_cast<std::uint8_t>(pick(256))});
        texture.wrap_u = static_cast<Texture::Wrap>(i);
        texture.wrap_v = static_cast<Texture::Wrap>(pick(3));
    }
    for (std::size_t i = 0; i < 5; ++i) {
        Material& m = scene.materials.emplace_back();
        m.name = "material " + std::to_string(i);
        m.base_color = {number(), number(), number()};
        m.alpha = number();
        m.metallic = number();
        m.roughness = number();
        m.emission = {10 * number(), 0.5f * number(), number()};
        m.alpha_mode = static_cast<Material::Alpha>(i % 3);
        m.alpha_cutoff = number();
        m.double_sided = i % 2 == 0;
        m.unlit = i == 4;
        m.ior = 1 + number();
        m.specular = number();
        m.specular_color = {2 * number(), number(), number()};
        const auto use = [&](std::size_t texture) {
            TextureUse u{texture, pick(2), {}};
            const float angle = 6 * number() - 3, sx = number() + 0.1f, sy = 3 * number() - 1.5f;
            u.uv_from_mesh = {{{std::cos(angle) * sx, std::sin(angle) * sy, number()},
                               {-std::sin(angle) * sx, std::cos(angle) * sy, number()}}};
            return u;
        };
        m.base_color_texture = use(0);
        if (i == 0) m.base_color_texture->uv_from_mesh = TextureUse{}.uv_from_mesh;
        if (i < 3) m.metallic_roughness_texture = use(1);
        if (i < 2) m.emissive_texture = use(2);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        Mesh& mesh = scene.meshes.emplace_back();
        mesh.name = "mesh " + std::to_string(i);
        const std::size_t triangles = 4 + pick(20);
        for (std::size_t k = 0; k < 3 * triangles; ++k) {
            mesh.positions.push_back(point());
            if (i != 1) mesh.normals.push_back(normalize(point() + Vec3{0, 0, 20}));
            mesh.uv[0].push_back({number(), number()});
            if (i > 1) mesh.uv[1].push_back({number(), number()});
            if (i != 3) mesh.lightmap_uv.push_back({number(), number()});
            if (i == 0) mesh.colors.push_back({number(), number(), number(), number()});
        }
        for (std::uint32_t t = 0; t < triangles; ++t) {
            mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
            mesh.materials.push_back(static_cast<std::uint32_t>(pick(5)));
        }
    }
    for (std::size_t i = 0; i < 6; ++i) {
        Transform t{rotation_about(normalize(point()), static_cast<double>(number())), point()};
        t.rows[0] = t.rows[0] * 2.0f;
        scene.objects.push_back({"object " + std::to_string(i), i % 4, t});
    }
    for (int i = 0; i < 6; ++i) {
        PunctualLight& light = scene.lights.emplace_back();
        light.kind = static_cast<PunctualLight::Kind>(i % 3);
        light.name = "light " + std::to_string(i);
        light.intensity = {100 * number(), number(), number()};
        if (light.kind != PunctualLight::Kind::directional) light.position = point();
        if (light.kind != PunctualLight::Kind::point) light.direction = normalize(point());
        if (light.kind == PunctualLight::Kind::spot) light.inner_angle = 0.5f * number(), light.outer_angle = 0.6f;
        if (light.kind == PunctualLight::Kind::directional) light.angular_radius = 0.01f * number();
        if (light.kind == PunctualLight::Kind::point) light.range = number();
    }
    scene.cameras.push_back({"eye", {rotation_about(normalize(point()), 1), point()}, 0.3f + number()});
    return scene;
}

TEST(RoundTrip, RandomScenes) {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const Scene scene = random_scene(seed);
        ASSERT_TRUE(check_scene(scene)) << check_scene(scene).error().message;
        Scene loaded = written_and_read(scene);
        // A second set that is not the lightmap's is TEXCOORD_2; the lowest two that are used are read: 0 and 2.
        expect_same(scene, loaded);
    }
}

TEST(RoundTrip, SetsOfCoordinatesAreNumberedWithoutGaps) {
    Scene scene = random_scene(1);
    scene.meshes[3].uv[0].clear();
    const std::string bytes = encode_glb(scene).value();
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, bytes.data() + 12, sizeof json_bytes);
    const json root = json::parse(bytes.substr(20, json_bytes));
    for (const json& mesh : root["meshes"])
        for (const json& primitive : mesh["primitives"])
            for (int set = 2; set > 0; --set)
                EXPECT_LE(primitive["attributes"].contains("TEXCOORD_" + std::to_string(set)),
                          primitive["attributes"].contains("TEXCOORD_" + std::to_string(set - 1)));
    EXPECT_TRUE(written_and_read(scene).meshes[3].lightmap_uv.empty());
}

TEST(RoundTrip, LightmapUvsAndExtrasOfTheWriter) {
    const Scene scene = cornell_scene();
    GltfWriteOptions options;
    options.scene_extras = R"({"lobelia": {"bake": 7}})";
    options.object_extras.resize(scene.objects.size());
    options.object_extras[1] = R"({"page": 3})";
    options.lightmap_uv.resize(scene.objects.size());
    for (const Vec2 uv : scene.meshes[2].lightmap_uv) options.lightmap_uv[2].push_back({0.5f * uv.x, 0.25f * uv.y});
    const Scene loaded = written_and_read(scene, options);
    EXPECT_EQ(loaded.meshes[2].lightmap_uv, options.lightmap_uv[2]);
    EXPECT_EQ(loaded.meshes[1].lightmap_uv, scene.meshes[1].lightmap_uv);

    const std::string bytes = encode_glb(scene, options).value();
    EXPECT_TRUE(has(bytes, R"("extras":{"lobelia":{"bake":7}})"));
    EXPECT_TRUE(has(bytes, R"("extras":{"page":3})"));
    EXPECT_EQ(bytes, encode_glb(scene, options).value());
    options.scene_extras = "[1]";
    EXPECT_FALSE(encode_glb(scene, options));
}

// ---------------------------------------------------------------------------------------------- content

TEST(Gltf, SquareIsReadAsItIs) {
    const Scene scene = scene_of(square_file());
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.lightmap_uv.empty());
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "default");
    EXPECT_EQ(scene.objects[0].name, "square node");
}

/// Integers, normalised or not, give the numbers that they stand for.
template <class T>
void expect_integers(std::vector<T> stored, bool normalized, std::vector<Vec3> expected) {
    GltfFile file = square_file();
    const auto accessor = file.accessor(stored, 3, normalized);
    file.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
    file.root["meshes"][0]["primitives"][0].erase("indices");
    const Scene scene = scene_of(file);
    ASSERT_EQ(scene.meshes.size(), 1u);
    for (std::size_t i = 0; i < expected.size(); ++i) expect_near(scene.meshes[0].positions[i], expected[i], 1e-7f);
}

TEST(Gltf, EveryComponentType) {
    expect_integers<std::int8_t>({-128, -127, 0, 127, 64, 1, 5, 6, 7}, true,
                                 {{-1, -1, 0}, {1, 64 / 127.0f, 1 / 127.0f}});
    expect_integers<std::int8_t>({-128, -127, 0, 127, 64, 1, 5, 6, 7}, false, {{-128, -127, 0}, {127, 64, 1}});
    expect_integers<std::uint8_t>({0, 255, 51, 1, 2, 3, 5, 6, 8}, true, {{0, 1, 0.2f}});
    expect_integers<std::int16_t>({-32768, 32767, 0, 1, 2, 3, 5, 6, 8}, true, {{-1, 1, 0}});
    expect_integers<std::uint16_t>({0, 65535, 13107, 1, 2, 3, 5, 6, 8}, true, {{0, 1, 0.2f}});
    expect_integers<std::uint16_t>({0, 65535, 13107, 1, 2, 3, 5, 6, 8}, false, {{0, 65535, 13107}});
    expect_integers<float>({0.5f, -1, 2, 1, 2, 3, 5, 6, 8}, false, {{0.5f, -1, 2}});
}

TEST(Gltf, EveryIndexType) {
    const auto with = [](auto zero) {
        GltfFile file = square_file();
        std::vector<decltype(zero)> indices{3, 0, 1, 1, 2, 3};
        file.root["meshes"][0]["primitives"][0]["indices"] = file.accessor(indices, 1);
        return scene_of(file).meshes.at(0).triangles;
    };
    const std::vector<std::array<std::uint32_t, 3>> expected{{3, 0, 1}, {1, 2, 3}};
    EXPECT_EQ(with(std::uint8_t{}), expected);
    EXPECT_EQ(with(std::uint16_t{}), expected);
    EXPECT_EQ(with(std::uint32_t{}), expected);
}

/// Strips and fans keep their fronts in front.
TEST(Gltf, StripsAndFansFaceForward) {
    const auto normals = [](int mode, const std::vector<float>& positions) {
        GltfFile file = square_file();
        json& primitive = file.root["meshes"][0]["primitives"][0];
        primitive.erase("indices");
        primitive["mode"] = mode;
        primitive["attributes"]["POSITION"] = file.accessor(positions, 3);
        const World world = make_world(scene_of(file));
        std::vector<Vec3> result;
        for (std::size_t t = 0; t < world.triangles.size(); ++t) result.push_back(world.face_normal(t));
        return result;
    };
    const std::vector<Vec3> up(3, {0, 0, 1});
    EXPECT_EQ(normals(5, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}), up);
    EXPECT_EQ(normals(6, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0}), up);
}

TEST(Gltf, UnusedVerticesAreLeftOutInOrder) {
    GltfFile file = square_file();
    std::vector<float> many(3 * 1000);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<float>(i * i % 977);
    json& primitive = file.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = file.accessor(many, 3);
    primitive["indices"] = file.accessor(std::vector<std::uint16_t>{900, 5, 17, 5, 17, 400}, 1);
    const Mesh mesh = scene_of(file).meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[0], (Vec3{many[15], many[16], many[17]}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{3, 0, 1}, {0, 1, 2}}));
}

TEST(Gltf, RichFileIsReadAsItIs) {
    const Scene scene = scene_of(rich_file());
    ASSERT_EQ(scene.meshes.size(), 2u);
    const Mesh& mesh = scene.meshes[1];
    // Strip of 4 vertices, fan of 4; positions with a stride of 8 bytes.
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.positions[1], (Vec3{9, 0, 0}));
    EXPECT_EQ(mesh.positions[5], (Vec3{1, 0, 0}));  // sparse
    EXPECT_EQ(mesh.positions[6], (Vec3{0, 0, 0}));
    EXPECT_EQ(mesh.uv[0][1], (Vec2{1, 0}));
    EXPECT_EQ(mesh.colors[1], (std::array<float, 4>{0, 1, 0, 1}));
    EXPECT_EQ(mesh.colors[7], (std::array<float, 4>{1, 1, 1, 1}));
    EXPECT_TRUE(mesh.lightmap_uv.empty());  // the fan has none

    const Material& m = scene.materials[0];
    EXPECT_EQ(m.emission, (Rgb{20, 10, 0}));
    EXPECT_EQ(m.alpha, 0.8f);
    EXPECT_EQ(m.alpha_mode, Material::Alpha::mask);
    EXPECT_EQ(m.ior, 1.33f);
    EXPECT_EQ(m.specular_color, (Rgb{1, 2, 3}));
    ASSERT_TRUE(m.base_color_texture);
    EXPECT_EQ(m.base_color_texture->uv_set, 1u);  // the extension's texCoord
    EXPECT_TRUE(scene.materials[1].unlit);
    ASSERT_EQ(scene.textures.size(), 2u);
    EXPECT_EQ(scene.textures[0].wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(scene.textures[0].texels[1], (std::array<std::uint8_t, 4>{0, 255, 0, 128}));

    // Node 0; node 3's children 1 and 2, the latter twice; all moved by its parent.
    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(transform_point(scene.objects[1].world_from_object, {1, 1, 1}), (Vec3{10 + 1 - 2, 2 + 2, 3 - 2}));
    EXPECT_EQ(scene.objects[3].world_from_object.translation, (Vec3{15, 0, 0}));
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].intensity, (Rgb{10, 5, 2.5f}));
    EXPECT_EQ(scene.lights[1].direction, (Vec3{0, 0, -1}));
    EXPECT_EQ(scene.lights[2].angular_radius, 0.005f);
    EXPECT_EQ(scene.cameras[0].world_from_camera.translation, (Vec3{0, 0, 5}));
}

/// The lower left quarter of the picture, by the example in KHR_texture_transform.
TEST(Gltf, TextureTransformRotatesAsSpecified) {
    GltfFile file = rich_file();
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
        {"offset", {0, 1}}, {"rotation", 0.5 * k_pi}, {"scale", {0.5, 0.5}}};
    const auto m = scene_of(file).materials.at(0).base_color_texture.value().uv_from_mesh;
    for (const Vec2 uv : {Vec2{0.1f, 0.2f}, Vec2{0.9f, 0.3f}, Vec2{0.5f, 0.95f}}) {
        const float u = m[0][0] * uv.x + m[0][1] * uv.y + m[0][2], v = m[1][0] * uv.x + m[1][1] * uv.y + m[1][2];
        EXPECT_TRUE(u > 0 && u < 0.5f && v > 0.5f && v < 1) << u << ' ' << v;
    }
}

TEST(Gltf, PhotometricUnitsAreDividedByTheEfficacy) {
    const Scene watts = scene_of(rich_file());
    const Scene lumens = scene_of(rich_file(), {.units = GltfReadOptions::Units::photometric});
    EXPECT_FLOAT_EQ(lumens.materials[0].emission.r * 179, watts.materials[0].emission.r);
    EXPECT_FLOAT_EQ(lumens.lights[0].intensity.g * 179, watts.lights[0].intensity.g);
    EXPECT_FLOAT_EQ(lumens.lights[2].intensity.g * 179, watts.lights[2].intensity.g);
}

TEST(Gltf, UvSetChoosesTheLightmap) {
    GltfFile file = square_file();
    json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = file.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 2);
    attributes["TEXCOORD_3"] = file.accessor(std::vector<float>{0, 0, 2, 0, 2, 2, 0, 2}, 2);
    EXPECT_TRUE(scene_of(file).meshes[0].lightmap_uv.empty());
    EXPECT_EQ(scene_of(file, {.uv_set = 0}).meshes[0].lightmap_uv[2], (Vec2{1, 1}));
    EXPECT_EQ(scene_of(file, {.uv_set = 3}).meshes[0].lightmap_uv[2], (Vec2{2, 2}));
    EXPECT_TRUE(scene_of(file).meshes[0].uv[0].empty());  // no texture needs it
}

TEST(Gltf, FlatPartsOfSmoothMeshesStayFlat) {
    GltfFile file = square_file();
    json primitive = file.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = file.accessor(std::vector<float>{0, 0, 3, 0, 3, 4, 0, 0, 0, NAN, 0, 1}, 3);
    file.root["meshes"][0]["primitives"].push_back(primitive);
    const auto loaded = read(file.glb());
    ASSERT_TRUE(loaded) << loaded.error().message;
    const Mesh& mesh = loaded->scene.meshes[0];
    ASSERT_EQ(mesh.normals.size(), 6u + 4u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(mesh.normals[i], (Vec3{0, 0, 1}));
    expect_near(mesh.normals[7], {0, 0.6f, 0.8f});
    EXPECT_EQ(mesh.normals[8], (Vec3{0, 0, 1}));
    EXPECT_EQ(mesh.normals[9], (Vec3{0, 0, 1}));
    ASSERT_EQ(loaded->warnings.size(), 1u);
    EXPECT_TRUE(has(loaded->warnings[0], "2 normals without a direction"));
}

TEST(Gltf, DeepHierarchiesAreNoStackOverflow) {
    GltfFile file = square_file();
    constexpr int k_depth = 50000;
    file.root["nodes"][0]["children"] = {1};
    for (int i = 1; i < k_depth; ++i) file.add("nodes", {{"children", {i + 1}}, {"translation", {0, 1, 0}}});
    file.add("nodes", {{"mesh", 0}});
    const auto loaded = read(file.gltf());
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->scene.objects[1].world_from_object.translation.y, k_depth - 1);
}

TEST(Gltf, WarningsNameWhatIsLeftOut) {
    GltfFile file = rich_file();
    file.root["extensionsUsed"].push_back("KHR_materials_transmission");
    file.root["extensionsUsed"].push_back("KHR_node_visibility");
    file.root["nodes"][0]["skin"] = 0;
    file.root["animations"] = {{{"channels", nlohmann::json::array()}}};
    const std::size_t first = file.root["materials"].size();
    for (const char* map : {"normalTexture", "occlusionTexture", "normalTexture"})
        file.add("materials", {{"name", "bumpy"}, {map, {{"index", 0}}}});
    const auto loaded = read(file.glb());
    ASSERT_TRUE(loaded) << loaded.error().message;
    std::string all;
    for (const std::string& warning : loaded->warnings) all += warning + "\n";
    EXPECT_TRUE(has(all, "KHR_materials_transmission: not read"));
    EXPECT_TRUE(has(all, "KHR_node_visibility: not read"));
    EXPECT_TRUE(has(all, "nodes[0]: its skin is not read"));
    EXPECT_TRUE(has(all, "animations: not read"));
    const std::string at = "materials[" + std::to_string(first);
    EXPECT_TRUE(has(all, "materials: 2 with normal maps, the first " + at + "] \"bumpy\": not read"));
    EXPECT_TRUE(has(all, "materials: 1 with occlusion maps, the first materials[" + std::to_string(first + 1)));
    EXPECT_TRUE(has(all, "meshes[1].primitives[2]: points or lines"));
    EXPECT_TRUE(has(all, "meshes[1]: only 1 of 2 parts have TEXCOORD_1"));
}

// ---------------------------------------------------------------------------------------------- bad input

TEST(BadGltf, ContainerIsNamed) {
    EXPECT_TRUE(has(error_of(""), "test.glb: the file is empty"));
    EXPECT_TRUE(has(error_of("hello"), "neither a .glb nor a .gltf"));
    EXPECT_TRUE(has(error_of("{\"asset\":"), "not a glTF file: parse error"));
    EXPECT_TRUE(has(error_of("{}"), "asset.version: missing"));
    EXPECT_TRUE(has(error_of(R"({"asset":{"version":"1.0"}})"), "glTF \"1.0\" is not read"));
    EXPECT_TRUE(has(error_of(R"({"asset":{"version":"2.0"},"nodes":7})"), "nodes: not an array"));
    EXPECT_TRUE(has(error_of(R"({"asset":{"version":"2.0"},"nodes":[7]})"), "nodes[0]: not an object"));
    EXPECT_TRUE(has(error_of(std::string(10000, '[') + "]"), "neither a .glb"));
    EXPECT_TRUE(has(error_of("{\"a\":" + std::string(100000, '[')), "nests more than 64 levels"));
    const std::string glb = square_file().glb();
    EXPECT_TRUE(has(error_of(glb.substr(0, glb.size() - 8)), "cut short"));
    std::string version = glb;
    version[4] = 1;
    EXPECT_TRUE(has(error_of(version), "GLB version 1 is not read"));
}

/// Whatever is cut off, it is an error and nothing worse.
TEST(BadGltf, EveryTruncationIsRefused) {
    for (const std::string& whole : {rich_file().glb(), rich_file().gltf()})
        for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + size / 64)
            EXPECT_FALSE(read(whole.substr(0, size))) << size;
}

/// Spoils one thing in a rich file and expects the message to name it.
void expect_error(std::string_view message, const std::function<void(GltfFile&)>& spoil,
                  const GltfReadOptions& options = {}) {
    GltfFile file = rich_file();
    spoil(file);
    EXPECT_TRUE(has(error_of(file.glb(), options), message));
    EXPECT_TRUE(has(error_of(file.gltf(), options), message));
}

TEST(BadGltf, PlaceIsNamed) {
    using F = GltfFile;
    const auto primitive = [](F& f) -> json& { return f.root["meshes"][0]["primitives"][0]; };
    expect_error("meshes[0].primitives[0].attributes.POSITION: accessor 99 of",
                 [&](F& f) { primitive(f)["attributes"]["POSITION"] = 99; });
    expect_error("meshes[0].primitives[0].attributes.POSITION: missing",
                 [&](F& f) { primitive(f)["attributes"].erase("POSITION"); });
    expect_error("meshes[0].primitives[0].indices (accessors[1]): 7 elements from byte 0 on exceed the 12 bytes",
                 [](F& f) { f.root["accessors"][1]["count"] = 7; });
    expect_error("meshes[0].primitives[0].indices: element 2 is vertex 2 of 2",
                 [](F& f) { f.root["accessors"][0]["count"] = 2; });
    expect_error("meshes[0].primitives[0].indices: not a whole number", [&](F& f) { primitive(f)["indices"] = -1; });
    expect_error("meshes[0].primitives[0].indices: not unsigned integers", [&](F& f) { primitive(f)["indices"] = 0; });
    expect_error("meshes[0].primitives[0].material: 9 of 2", [&](F& f) { primitive(f)["material"] = 9; });
    expect_error("meshes[0].primitives[0].mode: 9", [&](F& f) { primitive(f)["mode"] = 9; });
    expect_error("accessors[0].count: not a whole number", [](F& f) { f.root["accessors"][0]["count"] = 1e9; });
    expect_error("exceed the 48 bytes", [](F& f) { f.root["accessors"][0]["count"] = 2000000000; });
    expect_error("componentType 5130 is not read", [](F& f) { f.root["accessors"][0]["componentType"] = 5130; });
    expect_error("matrices are not read", [](F& f) { f.root["accessors"][0]["type"] = "MAT4"; });
    expect_error("bufferView 70 of", [](F& f) { f.root["accessors"][0]["bufferView"] = 70; });
    expect_error("bufferViews[0]: buffer 5 of 1", [](F& f) { f.root["bufferViews"][0]["buffer"] = 5; });
    expect_error("bufferViews[0]: bytes 0 + 18446744073709551615 of a buffer",
                 [](F& f) { f.root["bufferViews"][0]["byteLength"] = ~std::uint64_t{0}; });
    expect_error("byteStride 4 for elements of 12", [](F& f) { f.root["bufferViews"][0]["byteStride"] = 4; });
    expect_error("elements without data", [](F& f) {
        f.root["accessors"][0].erase("bufferView");
        f.root["accessors"][0]["count"] = 2000000000;
    });
    expect_error("sparse.indices: element 1 is 1: not ascending below 4",
                 [](F& f) { f.binary[f.root["bufferViews"][5]["byteOffset"].get<std::size_t>() + 1] = 1; });
    expect_error("nodes[0].mesh: 9 of 2", [](F& f) { f.root["nodes"][0]["mesh"] = 9; });
    expect_error("nodes[0].camera: 9 of 1", [](F& f) { f.root["nodes"][0]["camera"] = 9; });
    expect_error("nodes[0].scale: not 3 numbers", [](F& f) { f.root["nodes"][0]["scale"] = {1, 2}; });
    expect_error("nodes[3].children: 77 of 8", [](F& f) { f.root["nodes"][3]["children"] = {77}; });
    expect_error("nodes[1]: it has several parents, nodes[0] and nodes[3]",
                 [](F& f) { f.root["nodes"][0]["children"] = {1}; });
    expect_error("nodes[2]: it is among its own ancestors", [](F& f) {
        f.root["nodes"][3]["children"] = {1};
        f.root["nodes"][2]["children"] = {2};
    });
    expect_error("scenes[0].nodes: nodes[1] is no root", [](F& f) { f.root["scenes"][0]["nodes"] = {1}; });
    expect_error("scenes[0].nodes: nodes[0] stands there twice", [](F& f) { f.root["scenes"][0]["nodes"] = {0, 0}; });
    expect_error("scene: 4 of 1", [](F& f) { f.root["scene"] = 4; });
    expect_error("its place in the world is not finite", [](F& f) {
        f.root["nodes"][3]["matrix"][0] = 1e30;
        f.root["nodes"][1]["scale"] = {1e30, 1, 1};
    });
    expect_error("there are no triangles", [](F& f) { f.root["scenes"][0]["nodes"] = {4}; });
    expect_error("materials[0].pbrMetallicRoughness.baseColorTexture.index: 9 of 2",
                 [](F& f) { f.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 9; });
    expect_error("materials[0].alphaMode: neither", [](F& f) { f.root["materials"][0]["alphaMode"] = "GLASS"; });
    expect_error("materials[0]: its emission", [](F& f) { f.root["materials"][0]["emissiveFactor"] = {-1, 0, 0}; });
    expect_error("textures[0].sampler: 3 of 1", [](F& f) { f.root["textures"][0]["sampler"] = 3; });
    expect_error("textures[0].source: 3 of 2", [](F& f) { f.root["textures"][0]["source"] = 3; });
    expect_error("images[0]: must have either", [](F& f) { f.root["images"][0].erase("bufferView"); });
    expect_error("images[1].uri: \"data:image/png;base64,####\": a character that is not base64",
                 [](F& f) { f.root["images"][1]["uri"] = "data:image/png;base64,####"; });
    expect_error("images[1]: neither PNG nor JPEG",
                 [](F& f) { f.root["images"][1]["uri"] = "data:image/png;base64,AAAA"; });
    expect_error("lights[1].spot: 0 <= inner",
                 [](F& f) { f.root["extensions"]["KHR_lights_punctual"]["lights"][1]["spot"]["innerConeAngle"] = 1; });
    expect_error("nodes[4].extensions.KHR_lights_punctual.light: not an index below 3",
                 [](F& f) { f.root["nodes"][4]["extensions"]["KHR_lights_punctual"]["light"] = 3; });
    expect_error("cameras[0].perspective.yfov", [](F& f) { f.root["cameras"][0]["perspective"]["yfov"] = 4; });
}

TEST(BadGltf, NumbersThatAreNone) {
    for (const float bad : {NAN, INFINITY}) {
        expect_error("meshes[0].primitives[0].attributes.POSITION: element 2 is not finite", [&](GltfFile& f) {
            const auto at = f.root["bufferViews"][0]["byteOffset"].get<std::size_t>();
            std::memcpy(f.binary.data() + at + 24, &bad, sizeof bad);
        });
    }
    GltfFile file = square_file();
    file.root["meshes"][0]["primitives"][0]["indices"] = file.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 2}, 1);
    const auto loaded = read(file.glb());
    ASSERT_TRUE(loaded);
    ASSERT_EQ(loaded->warnings.size(), 1u);
    EXPECT_TRUE(has(loaded->warnings[0], "1 triangle without area, the first is meshes[0], triangle 1"));
}

TEST(BadGltf, RequiredExtensionsNameTheRemedy) {
    const auto required = [](const char* name) {
        GltfFile file = square_file();
        file.root["extensionsRequired"] = {name};
        return error_of(file.glb());
    };
    EXPECT_TRUE(has(required("KHR_draco_mesh_compression"), "gltf-transform copy IN.glb OUT.glb"));
    EXPECT_TRUE(has(required("EXT_meshopt_compression"), "gltf-transform copy IN.glb OUT.glb"));
    EXPECT_TRUE(has(required("KHR_texture_basisu"), "gltf-transform ktxdecompress"));
    EXPECT_TRUE(has(required("EXT_texture_webp"), "gltf-transform png"));
    EXPECT_TRUE(has(required("ACME_secret"), "extensionsRequired: ACME_secret is not read"));
    EXPECT_EQ(required("KHR_mesh_quantization"), "read without an error");
}

/// Compressed without being required to be read: plain data is taken where there is any.
TEST(BadGltf, CompressedDataWithoutAFallbackNamesTheRemedy) {
    GltfFile file = square_file();
    file.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
    EXPECT_EQ(error_of(file.glb()), "read without an error");
    file.root["accessors"][0].erase("bufferView");
    EXPECT_TRUE(has(error_of(file.glb()), "meshes[0].primitives[0]: KHR_draco_mesh_compression is not read"));

    json root = square_file().root;
    root["buffers"] =
        json::array({{{"byteLength", 60}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
    EXPECT_TRUE(has(error_of(root.dump()), "bufferViews[0]: EXT_meshopt_compression is not read"));
}

TEST(BadGltf, LimitsHoldBeforeAllocation) {
    GltfReadOptions options;
    options.most_triangles = 5;
    EXPECT_TRUE(has(error_of(rich_file().glb(), options), "2 triangles; at most 1 are left to be read"));
    options = {};
    options.most_objects = 3;
    EXPECT_TRUE(has(error_of(rich_file().glb(), options), "more than 3 objects"));
    options = {};
    options.most_texels = 7;
    EXPECT_TRUE(has(error_of(rich_file().glb(), options), "images[1]: the image is 2 x 2 pixels"));
    options = {};
    options.most_bytes = 10;
    EXPECT_TRUE(has(error_of(rich_file().gltf(), options), "too large together"));
}

// ---------------------------------------------------------------------------------------------- files

class GltfFolder : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() / ("lobelia-gltf-test-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_ / "scene" / "textures");
        file_ = rich_file();
        write("scene/data file.bin", file_.binary);
        write("scene/textures/a.png", small_png());
        write("secret.bin", file_.binary);
        buffer("data%20file.bin");
        file_.root["images"][1] = {{"uri", "textures/a.png"}};
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    void buffer(const std::string& uri) {
        file_.root["buffers"] = json::array({{{"byteLength", file_.binary.size()}, {"uri", uri}}});
    }
    std::string error() const {
        write("scene/scene.gltf", file_.root.dump());
        const auto loaded = read_gltf(folder_ / "scene" / "scene.gltf");
        return loaded ? "read without an error" : loaded.error().message;
    }

    std::filesystem::path folder_;
    GltfFile file_;
};

TEST_F(GltfFolder, ExternalFilesAreRead) {
    EXPECT_EQ(error(), "read without an error");
    const auto loaded = read_gltf(folder_ / "scene" / "scene.gltf");
    expect_same(scene_of(rich_file()), loaded->scene);
}

TEST_F(GltfFolder, PathsOutOfTheFolderAreRefused) {
    for (const char* uri : {"../secret.bin", "textures/../../secret.bin", "%2e%2e/secret.bin", "..%2fsecret.bin"}) {
        buffer(uri);
        EXPECT_TRUE(has(error(), "buffers[0].uri")) << uri;
        EXPECT_TRUE(has(error(), "leads out of the scene's folder")) << uri;
    }
    for (const char* uri : {"/etc/passwd", "%2Fetc%2Fpasswd"}) {
        buffer(uri);
        EXPECT_TRUE(has(error(), "an absolute path")) << uri;
    }
    for (const char* uri :
         {"file:///etc/passwd", "http://example.org/a.bin", "C:\\a.bin", "a%00.bin", "..\\secret.bin"}) {
        buffer(uri);
        EXPECT_TRUE(has(error(), "only plain relative paths are read")) << uri;
    }
    buffer("a%2.bin");
    EXPECT_TRUE(has(error(), "percent sign"));
    file_.root["images"][1]["uri"] = "../secret.png";
    buffer("data%20file.bin");
    EXPECT_TRUE(has(error(), "images[1].uri: \"../secret.png\" is refused"));
}

TEST_F(GltfFolder, LinksOutOfTheFolderAreRefused) {
    std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "scene" / "link.bin");
    std::filesystem::create_directory_symlink(folder_, folder_ / "scene" / "up");
    std::filesystem::create_symlink("data file.bin", folder_ / "scene" / "inner.bin");
    for (const char* uri : {"link.bin", "up/secret.bin"}) {
        buffer(uri);
        EXPECT_TRUE(has(error(), "leads out of the scene's folder")) << uri;
    }
    buffer("inner.bin");
    EXPECT_EQ(error(), "read without an error");
}

TEST_F(GltfFolder, MissingAndShortFilesAreNamed) {
    buffer("gone.bin");
    EXPECT_TRUE(has(error(), "buffers[0].uri"));
    EXPECT_TRUE(has(error(), "gone.bin: No such file"));
    buffer("textures");
    EXPECT_TRUE(has(error(), "not a regular file"));
    buffer("textures/a.png");
    EXPECT_TRUE(has(error(), "but byteLength is"));
    EXPECT_TRUE(has(read_gltf(folder_ / "no.glb").error().message, "no.glb: cannot be read: No such file"));
    EXPECT_TRUE(has(read_gltf(folder_).error().message, "not a regular file"));
}

TEST(Picture, DecodesWhatItEncodes) {
    const std::string png = small_png();
    const auto picture = read_picture_rgba8(std::as_bytes(std::span(png)), "a.png", 4);
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_EQ(picture->texels[3], (std::array<std::uint8_t, 4>{10, 20, 30, 40}));
    EXPECT_FALSE(read_picture_rgba8(std::as_bytes(std::span(png)), "a.png", 3));
    for (const std::string bad : {"", "RIFF", "RIFF1234WEBP", "\xabKTX 20", "BM123"})
        EXPECT_FALSE(read_picture_rgba8(std::as_bytes(std::span(bad)), "a.png", 100));
}

}  // namespace
}  // namespace lobelia
