// Tests the copy of the scene in a bake: its lightmap UVs are those of the pages, and nothing else differs.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "bake/write/manifest.h"
#include "bake/write/scene_copy.h"
#include "folders.h"
#include "io/read_image.h"
#include "lobelia/gltf.h"
#include "scene/embedded.h"

namespace lobelia {
namespace {

/// An empty bake of a scene, its objects packed.
struct Packed {
    explicit Packed(Scene s) : scene(std::move(s)), world(make_world(scene)) {
        BakeOptions options;
        options.atlas.width = 96;
        options.atlas.height = 80;
        options.atlas.layout = AtlasOptions::Layout::packed;
        const auto atlas = Atlas::make(world, options.atlas);
        EXPECT_TRUE(atlas);
        bake.manifest = make_manifest(scene, *atlas, options);
        for (std::size_t i = 0; i < atlas->pages(); ++i) {
            bake.pages.emplace_back(96, 80, bake.channels().count());
            bake.normals.emplace_back(bake.pages.back().size());
        }
    }
    Scene scene;
    World world;
    Bake bake;
};

TEST(SceneCopy, LightmapUvsAreThePages) {
    const test::TestFolder folder("scene-copy");
    const Packed packed(cornell_scene());
    ASSERT_TRUE(write_bake(folder.path(), packed.bake,
                           {.textures = {.storages = std::vector<std::string>{}}, .scene = &packed.scene}));
    const auto manifest = read_manifest(folder.path());
    ASSERT_TRUE(manifest && manifest->scene);
    EXPECT_TRUE(manifest->warnings.empty());
    EXPECT_FALSE(manifest->environment);
    const auto copy = read_gltf(folder.path() / *manifest->scene);
    ASSERT_TRUE(copy) << copy.error().message;

    // The same texel from the original's uv by the manifest's scale and offset as from the copy's uv alone.
    const World there = make_world(copy->scene);
    ASSERT_EQ(there.triangles.size(), packed.world.triangles.size());
    for (std::size_t t = 0; t < there.triangles.size(); ++t) {
        const std::size_t object = packed.world.object[t];
        ASSERT_EQ(there.object[t], object);
        const AtlasPlacement own = manifest->objects[object].placement, copied = placement_in_copy(*manifest, object);
        EXPECT_EQ(own.page, copied.page);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = packed.world.triangles[t][k], b = there.triangles[t][k];
            EXPECT_EQ(packed.world.positions[a], there.positions[b]);
            const Vec2 u = packed.world.lightmap_uv[a], v = there.lightmap_uv[b];
            EXPECT_NEAR(own.scale.x * u.x + own.offset.x, copied.scale.x * v.x + copied.offset.x, 2e-5f);
            EXPECT_NEAR(own.scale.y * u.y + own.offset.y, copied.scale.y * v.y + copied.offset.y, 2e-5f);
        }
    }
    const std::string bytes = test::contents(folder.path() / *manifest->scene);
    EXPECT_NE(bytes.find(R"({"lobelia_lightmap":{)"), std::string::npos);
    EXPECT_NE(bytes.find(R"("file":"page-0.exr")"), std::string::npos);
}

/// The JSON of a .glb file.
nlohmann::json json_of(const std::filesystem::path& file) {
    const std::string bytes = test::contents(file);
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    return nlohmann::json::parse(bytes.substr(20, length));
}

TEST(SceneCopy, TheExtensionSaysWhatTheManifestSays) {
    const test::TestFolder folder("scene-extension");
    const Packed packed(cornell_scene());
    ASSERT_TRUE(write_bake(folder.path(), packed.bake, {.scene = &packed.scene}));
    auto manifest = nlohmann::json::parse(test::contents(folder.path() / k_manifest_name));
    manifest["conventions"].erase("tangent_frame");  // null, which glTF does not allow
    const auto scene = json_of(folder.path() / "scene.glb");
    EXPECT_EQ(scene["extensionsUsed"].back(), "LOBELIA_lightmap");
    const auto& extension = scene["extensions"]["LOBELIA_lightmap"];
    EXPECT_EQ(extension["version"], 1);
    EXPECT_EQ(extension["manifest"], "bake.json");
    EXPECT_EQ(extension["texCoord"], 1);
    EXPECT_EQ(extension["codec"], manifest["codec"]);
    EXPECT_EQ(extension["conventions"], manifest["conventions"]);
    EXPECT_EQ(extension["pages"], manifest["layout"]["pages"]);
    EXPECT_EQ(extension["width"], 96);
    std::size_t lit = 0;
    for (const auto& node : scene["nodes"])
        if (node.contains("extensions") && node["extensions"].contains("LOBELIA_lightmap")) {
            EXPECT_EQ(node["extensions"]["LOBELIA_lightmap"]["page"], 0);
            ++lit;
        }
    EXPECT_EQ(lit, packed.scene.objects.size());
    const auto copy = read_gltf(folder.path() / "scene.glb");
    ASSERT_TRUE(copy);
    EXPECT_TRUE(copy->warnings.empty());
}

TEST(SceneCopy, PlainLightmapsForOtherViewers) {
    const test::TestFolder folder("scene-plain");
    Packed packed(cornell_scene());
    LightmapPage& page = packed.bake.pages[0];
    const PageChannels channels = packed.bake.channels();
    for (std::size_t i = 0; i < page.size(); ++i) {
        page.planes[channels.irradiance(0)][i] = i == 5 ? 8 * static_cast<float>(k_pi) : static_cast<float>(k_pi);
        page.planes[channels.irradiance(1)][i] = 2 * static_cast<float>(k_pi);
    }
    ASSERT_TRUE(write_bake(folder.path(), packed.bake, {.scene = &packed.scene, .exports = {{"moz-lightmap"}}}));
    const auto scene = json_of(folder.path() / "scene.glb");
    std::size_t primitives = 0;
    for (const auto& node : scene["nodes"]) {
        if (!node.contains("mesh")) continue;
        for (const auto& primitive : scene["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
            const auto& lightmap =
                scene["materials"][primitive["material"].get<std::size_t>()]["extensions"]["MOZ_lightmap"];
            EXPECT_EQ(lightmap["texCoord"], 1);
            EXPECT_NEAR(lightmap["intensity"].get<double>(), 8, 1e-5);
            EXPECT_EQ(scene["textures"][lightmap["index"].get<std::size_t>()]["source"], 0);
            EXPECT_TRUE(primitive["attributes"].contains("TEXCOORD_1"));
            ++primitives;
        }
    }
    EXPECT_GT(primitives, packed.scene.objects.size() - 1);

    // Read it again: the scene is the same, and the picture holds irradiance over pi.
    const auto copy = read_gltf(folder.path() / "scene.glb");
    ASSERT_TRUE(copy) << copy.error().message;
    EXPECT_TRUE(copy->warnings.empty());
    EXPECT_EQ(copy->scene.objects.size(), packed.scene.objects.size());
    const auto& view = scene["bufferViews"][scene["images"][0]["bufferView"].get<std::size_t>()];
    const std::string bytes = test::contents(folder.path() / "scene.glb");
    std::uint32_t json_length = 0;
    std::memcpy(&json_length, bytes.data() + 12, sizeof json_length);
    const std::size_t begin = 28 + json_length + view["byteOffset"].get<std::size_t>();
    const std::string png = bytes.substr(begin, view["byteLength"].get<std::size_t>());
    test::overwrite(folder.path() / "lightmap.png", png);
    const auto picture = read_environment(folder.path() / "lightmap.png", {.ldr = true});
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_NEAR(picture->image.pixels[0].r * 8, 1, 0.02f);
    EXPECT_NEAR(picture->image.pixels[0].g * 8, 2, 0.03f);
    EXPECT_NEAR(picture->image.pixels[5].r * 8, 8, 0.01f);
}

TEST(SceneCopy, TheEnvironmentGoesWithIt) {
    const test::TestFolder folder("scene-environment");
    Packed packed(cornell_scene());
    packed.scene.environment = Image(8, 4);
    packed.scene.environment->at(3, 2) = {1, 2, 3e-5f};
    ASSERT_TRUE(write_bake(folder.path(), packed.bake, {.scene = &packed.scene}));
    const auto manifest = read_manifest(folder.path());
    ASSERT_TRUE(manifest && manifest->environment);
    const auto image = read_environment(folder.path() / *manifest->environment);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->image.pixels, packed.scene.environment->pixels);
}

TEST(SceneCopy, WhatGltfCannotHoldCostsTheCopyNotTheBake) {
    const test::TestFolder folder("scene-refused");
    Packed packed(cornell_scene());
    packed.scene.textures.push_back({"t", 1, 1, {{1, 2, 3, 4}}});
    packed.scene.materials[0].base_color_texture = TextureUse{0, 0, {{{1, 0.5f, 0}, {0, 1, 0}}}};
    ASSERT_TRUE(write_bake(folder.path(), packed.bake, {.scene = &packed.scene}));
    const auto read = read_bake(folder.path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->manifest.scene);
    ASSERT_EQ(read->manifest.warnings.size(), 1u);
    EXPECT_NE(read->manifest.warnings[0].find("the scene was not copied: "), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "scene.glb"));
}

TEST(PlainBake, HasNoCoefficientsAndNoTextures) {
    const test::TestFolder folder("plain-bake");
    const Scene scene = cornell_scene();
    const World world = make_world(scene);
    BakeOptions options;
    options.codec.clear();
    options.atlas.width = options.atlas.height = 64;
    const auto atlas = Atlas::make(world, options.atlas);
    ASSERT_TRUE(atlas);
    Bake bake;
    bake.manifest = make_manifest(scene, *atlas, options);
    bake.pages.emplace_back(64, 64, bake.channels().count());
    bake.normals.emplace_back(64 * 64);
    ASSERT_TRUE(write_bake(folder.path(), bake));
    EXPECT_EQ(folder.entries(), 2u);
    auto read = read_bake(folder.path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(read->manifest.options.codec.empty());
    EXPECT_EQ(read->pages[0].planes.size(), 4u);

    std::string text = test::contents(folder.path() / k_manifest_name);
    const std::string none = "\"coefficients\": 0";
    test::overwrite(folder.path() / k_manifest_name, text.replace(text.find(none), none.size(), "\"coefficients\": 4"));
    read = read_bake(folder.path());
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("codec.coefficients: there is no codec"), std::string::npos)
        << read.error().message;
}

}  // namespace
}  // namespace lobelia
