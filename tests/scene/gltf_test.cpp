// Tests glTF: a written scene reads back equal, and every kind of content is read correctly.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <set>

#include "gltf_reading.h"
#include "lobelia/gltf.h"
#include "same_scenes.h"
#include "scene/check_scene.h"
#include "scene/embedded.h"
#include "scene/world.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::expect_near;
using test::expect_same;
using test::read_gltf_text;
using test::says;
using test::scene_of_gltf;

// ---------------------------------------------------------------------------------------------- round trip

Scene written_and_read(const Scene& scene, const GltfWriteOptions& options = {}) {
    const auto bytes = encode_glb(scene, options);
    EXPECT_TRUE(bytes) << bytes.error().message;
    auto loaded = read_gltf_text(*bytes);
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

/// A scene that uses every part of the model, with random values.
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
        texture.filter = static_cast<Texture::Filter>(i % 2);
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
            // Fronts are where the normals are, towards +z.
            const Vec3 a = mesh.positions[3 * t], b = mesh.positions[3 * t + 1], c = mesh.positions[3 * t + 2];
            const std::uint32_t turn = cross(b - a, c - a).z > 0 ? 1 : 2;
            mesh.triangles.push_back({3 * t, 3 * t + turn, 3 * t + 3 - turn});
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
    EXPECT_TRUE(says(bytes, R"("extras":{"lobelia":{"bake":7}})"));
    EXPECT_TRUE(says(bytes, R"("extras":{"page":3})"));
    EXPECT_EQ(bytes, encode_glb(scene, options).value());
    options.scene_extras = "[1]";
    EXPECT_FALSE(encode_glb(scene, options));
}

// ---------------------------------------------------------------------------------------------- content

TEST(Gltf, SquareIsReadAsItIs) {
    const Scene scene = scene_of_gltf(square_file());
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

/// Integers, normalised or not, are converted to the right numbers.
template <class T>
void expect_integers(std::vector<T> stored, bool normalized, std::vector<Vec3> expected) {
    GltfFile file = square_file();
    const auto accessor = file.accessor(stored, 3, normalized);
    file.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
    file.root["meshes"][0]["primitives"][0].erase("indices");
    const Scene scene = scene_of_gltf(file);
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
        return scene_of_gltf(file).meshes.at(0).triangles;
    };
    const std::vector<std::array<std::uint32_t, 3>> expected{{3, 0, 1}, {1, 2, 3}};
    EXPECT_EQ(with(std::uint8_t{}), expected);
    EXPECT_EQ(with(std::uint16_t{}), expected);
    EXPECT_EQ(with(std::uint32_t{}), expected);
}

/// Strips and fans keep their front faces.
TEST(Gltf, StripsAndFansFaceForward) {
    const auto normals = [](int mode, const std::vector<float>& positions) {
        GltfFile file = square_file();
        json& primitive = file.root["meshes"][0]["primitives"][0];
        primitive.erase("indices");
        primitive["mode"] = mode;
        primitive["attributes"]["POSITION"] = file.accessor(positions, 3);
        const World world = make_world(scene_of_gltf(file));
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
    const Mesh mesh = scene_of_gltf(file).meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[0], (Vec3{many[15], many[16], many[17]}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{3, 0, 1}, {0, 1, 2}}));
}

TEST(Gltf, RichFileIsReadAsItIs) {
    const Scene scene = scene_of_gltf(rich_file());
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
    const auto m = scene_of_gltf(file).materials.at(0).base_color_texture.value().uv_from_mesh;
    for (const Vec2 uv : {Vec2{0.1f, 0.2f}, Vec2{0.9f, 0.3f}, Vec2{0.5f, 0.95f}}) {
        const float u = m[0][0] * uv.x + m[0][1] * uv.y + m[0][2], v = m[1][0] * uv.x + m[1][1] * uv.y + m[1][2];
        EXPECT_TRUE(u > 0 && u < 0.5f && v > 0.5f && v < 1) << u << ' ' << v;
    }
}

TEST(Gltf, PhotometricUnitsAreDividedByTheEfficacy) {
    const Scene watts = scene_of_gltf(rich_file());
    const Scene lumens = scene_of_gltf(rich_file(), {.units = GltfReadOptions::Units::photometric});
    EXPECT_FLOAT_EQ(lumens.materials[0].emission.r * 179, watts.materials[0].emission.r);
    EXPECT_FLOAT_EQ(lumens.lights[0].intensity.g * 179, watts.lights[0].intensity.g);
    EXPECT_FLOAT_EQ(lumens.lights[2].intensity.g * 179, watts.lights[2].intensity.g);
}

TEST(Gltf, UvSetChoosesTheLightmap) {
    GltfFile file = square_file();
    json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = file.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 2);
    attributes["TEXCOORD_3"] = file.accessor(std::vector<float>{0, 0, 2, 0, 2, 2, 0, 2}, 2);
    EXPECT_TRUE(scene_of_gltf(file).meshes[0].lightmap_uv.empty());
    EXPECT_EQ(scene_of_gltf(file, {.uv_set = 0}).meshes[0].lightmap_uv[2], (Vec2{1, 1}));
    EXPECT_EQ(scene_of_gltf(file, {.uv_set = 3}).meshes[0].lightmap_uv[2], (Vec2{2, 2}));
    EXPECT_TRUE(scene_of_gltf(file).meshes[0].uv[0].empty());  // no texture needs it
}

TEST(Gltf, FlatPartsOfSmoothMeshesStayFlat) {
    GltfFile file = square_file();
    json primitive = file.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = file.accessor(std::vector<float>{0, 0, 3, 0, 3, 4, 0, 0, 0, NAN, 0, 1}, 3);
    file.root["meshes"][0]["primitives"].push_back(primitive);
    const auto loaded = read_gltf_text(file.glb());
    ASSERT_TRUE(loaded) << loaded.error().message;
    const Mesh& mesh = loaded->scene.meshes[0];
    ASSERT_EQ(mesh.normals.size(), 6u + 4u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(mesh.normals[i], (Vec3{0, 0, 1}));
    expect_near(mesh.normals[7], {0, 0.6f, 0.8f});
    EXPECT_EQ(mesh.normals[8], (Vec3{0, 0, 1}));
    EXPECT_EQ(mesh.normals[9], (Vec3{0, 0, 1}));
    ASSERT_EQ(loaded->warnings.size(), 1u);
    EXPECT_TRUE(says(loaded->warnings[0], "2 normals without a direction"));
}

TEST(Gltf, DeepHierarchiesAreNoStackOverflow) {
    GltfFile file = square_file();
    constexpr int k_depth = 50000;
    file.root["nodes"][0]["children"] = {1};
    for (int i = 1; i < k_depth; ++i) file.add("nodes", {{"children", {i + 1}}, {"translation", {0, 1, 0}}});
    file.add("nodes", {{"mesh", 0}});
    const auto loaded = read_gltf_text(file.gltf());
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->scene.objects[1].world_from_object.translation.y, k_depth - 1);
}

TEST(Gltf, WarningsNameWhatIsLeftOut) {
    GltfFile file = rich_file();
    file.root["extensionsUsed"].push_back("KHR_materials_transmission");
    file.root["animations"] = {{{"channels", nlohmann::json::array()}}};
    const std::size_t first = file.root["materials"].size();
    for (const char* map : {"normalTexture", "occlusionTexture", "normalTexture"})
        file.add("materials", {{"name", "bumpy"}, {map, {{"index", 0}}}});
    const auto loaded = read_gltf_text(file.glb());
    ASSERT_TRUE(loaded) << loaded.error().message;
    std::string all;
    for (const std::string& warning : loaded->warnings) all += warning + "\n";
    EXPECT_TRUE(says(all, "KHR_materials_transmission: not supported"));
    EXPECT_TRUE(says(all, "animations: not supported"));
    const std::string at = "materials[" + std::to_string(first);
    EXPECT_TRUE(says(all, "materials: 2 with normal maps, the first " + at + "] \"bumpy\": not supported"));
    EXPECT_TRUE(says(all, "materials: 1 with occlusion maps, the first materials[" + std::to_string(first + 1)));
    EXPECT_TRUE(says(all, "meshes[1].primitives[2]: points or lines"));
    EXPECT_TRUE(says(all, "meshes[1]: only 1 of 2 parts have TEXCOORD_1"));
}

}  // namespace
}  // namespace lobelia
