// Tests glTF files that are valid but often misread, and files as exporters write them.
#include <filesystem>

#include "data.h"
#include "gltf_reading.h"
#include "scene/check_scene.h"
#include "scene/world.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::gltf_error;
using test::read_gltf_text;
using test::says;
using test::scene_of_gltf;

/// Returns all warnings of a file, which must be readable.
std::string warnings_of(const GltfFile& file) {
    const auto loaded = read_gltf_text(file.glb());
    EXPECT_TRUE(loaded) << loaded.error().message;
    std::string all;
    for (const std::string& warning : loaded->warnings) all += warning + "\n";
    return all;
}

json& primitive_of(GltfFile& file) { return file.root["meshes"][0]["primitives"][0]; }

GltfFile with_light(const json& light) {
    GltfFile file = square_file();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
    file.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.root["scenes"][0]["nodes"] = {0, 1};
    return file;
}

// ---------------------------------------------------------------------------------------------- JSON

TEST(GltfJson, WholeNumbersMayBeWrittenAsFloats) {
    GltfFile file = square_file();
    std::string text = file.gltf();
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"\"count\":4", "\"count\":4.0"},
                                   {"\"componentType\":5126", "\"componentType\":5.126e3"},
                                   {"\"mesh\":0", "\"mesh\":0.0"}}) {
        ASSERT_NE(text.find(from), std::string::npos) << from;
        text.replace(text.find(from), from.size(), to);
    }
    EXPECT_EQ(gltf_error(text), "read without an error");
    file.root["nodes"][0]["mesh"] = 0.5;
    EXPECT_TRUE(says(gltf_error(file.glb()), "nodes[0].mesh: not a whole number"));
}

TEST(GltfJson, WrongTypesAreErrorsWithTheirPlace) {
    const auto error_with = [](const char* key, const json& value) {
        GltfFile file = square_file();
        file.add("materials", json::object());
        primitive_of(file)["material"] = 0;
        file.root["materials"][0][key] = value;
        return gltf_error(file.glb());
    };
    EXPECT_TRUE(says(error_with("pbrMetallicRoughness", 7), "materials[0].pbrMetallicRoughness: not an object"));
    EXPECT_TRUE(says(error_with("pbrMetallicRoughness", json::array()), "not an object"));
    EXPECT_TRUE(says(error_with("pbrMetallicRoughness", {{"baseColorFactor", "red"}}),
                     "materials[0].pbrMetallicRoughness.baseColorFactor: not 4 numbers"));
    EXPECT_TRUE(says(error_with("pbrMetallicRoughness", {{"baseColorFactor", {1, 1, "1", 1}}}),
                     "materials[0].pbrMetallicRoughness.baseColorFactor[2]: not a finite number"));
    EXPECT_TRUE(says(error_with("pbrMetallicRoughness", {{"metallicFactor", "1"}}), "metallicFactor: not a finite"));
    EXPECT_TRUE(says(error_with("pbrMetallicRoughness", {{"metallicFactor", nullptr}}), "metallicFactor: null"));
    EXPECT_TRUE(says(error_with("emissiveFactor", {1, 2}), "materials[0].emissiveFactor: not 3 numbers"));
    EXPECT_TRUE(says(error_with("doubleSided", "yes"), "materials[0].doubleSided: neither true nor false"));
    EXPECT_TRUE(says(error_with("extensions", 3), "materials[0].extensions: not an object"));
}

TEST(GltfJson, KeysMayNotStandTwice) {
    EXPECT_TRUE(says(gltf_error(R"({"asset":{"version":"2.0"},"nodes":[],"nodes":[{}]})"), "duplicate key \"nodes\""));
    EXPECT_TRUE(says(gltf_error(R"({"asset":{"version":"2.0"},"scene":NaN})"), "NaN and Infinity are not valid JSON"));
}

TEST(GltfJson, MinimumVersionsAreHeeded) {
    const auto error_with = [](const char* version, const char* minimum) {
        GltfFile file = square_file();
        file.root["asset"] = {{"version", version}, {"minVersion", minimum}};
        return gltf_error(file.glb());
    };
    EXPECT_EQ(error_with("2.0", "2.0"), "read without an error");
    EXPECT_EQ(error_with("2.1", "2.0"), "read without an error");
    EXPECT_TRUE(says(error_with("2.1", "2.1"), "asset.minVersion: glTF \"2.1\" is not supported"));
    EXPECT_TRUE(says(error_with("2.10", "2.10"), "asset.minVersion"));
    EXPECT_TRUE(says(error_with("2", "2.0"), "asset.version: glTF \"2\""));
}

// ---------------------------------------------------------------------------------------------- geometry

TEST(GltfGeometry, IndicesMayBeSparse) {
    GltfFile file = square_file();
    const auto at = file.view(std::vector<std::uint16_t>{1, 2, 4, 5});
    const auto values = file.view(std::vector<std::uint16_t>{1, 2, 2, 3});
    primitive_of(file)["indices"] = file.add("accessors", {{"componentType", 5123},
                                                           {"count", 6},
                                                           {"type", "SCALAR"},
                                                           {"sparse",
                                                            {{"count", 4},
                                                             {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                                                             {"values", {{"bufferView", values}}}}}});
    const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(scene_of_gltf(file).meshes.at(0).triangles, expected);
}

TEST(GltfGeometry, PrimitivesWithoutPositionsAreSkipped) {
    GltfFile file = square_file();
    file.root["meshes"][0]["primitives"].push_back({{"attributes", {{"NORMAL", 0}}}});
    EXPECT_EQ(scene_of_gltf(file).meshes.at(0).triangles.size(), 2u);
    EXPECT_TRUE(says(warnings_of(file), "meshes[0].primitives[1]: no POSITION; left out"));
}

TEST(GltfGeometry, NormalsAgainstTheWindingAreReported) {
    GltfFile file = square_file();
    primitive_of(file)["attributes"]["NORMAL"] =
        file.accessor(std::vector<float>{0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, 1}, 3);
    // Turn the normal of one corner of the second triangle to the front.
    EXPECT_TRUE(says(warnings_of(file),
                     "1 triangle with normals that point away from the front, the first is meshes[0], triangle 0"));
}

TEST(GltfGeometry, PartsWithoutLightmapUvsAreNamed) {
    GltfFile file = square_file();
    json second = primitive_of(file);
    primitive_of(file)["attributes"]["TEXCOORD_1"] = file.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 2);
    file.root["meshes"][0]["primitives"].push_back(second);
    const auto loaded = read_gltf_text(file.glb());
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->parts_without_lightmap_uv, std::vector<std::string>{"meshes[0].primitives[1]"});
}

// ---------------------------------------------------------------------------------------------- nodes

TEST(GltfNodes, EveryObjectHasANameOfItsOwn) {
    GltfFile file = square_file();
    file.root["nodes"] = {{{"name", "tile"}, {"mesh", 0}},
                          {{"name", "tile"}, {"mesh", 0}},
                          {{"name", "tile #1"}, {"mesh", 0}},
                          {{"name", "left"}, {"children", {4}}},
                          {{"name", "door"}, {"mesh", 0}},
                          {{"name", "right"}, {"children", {6}}},
                          {{"name", "door"}, {"mesh", 0}},
                          {{"mesh", 0}},
                          {{"mesh", 0}}};
    file.root["scenes"][0]["nodes"] = {0, 1, 2, 3, 5, 7, 8};
    std::vector<std::string> names;
    for (const Object& object : scene_of_gltf(file).objects) names.push_back(object.name);
    EXPECT_EQ(names, (std::vector<std::string>{"tile #2", "tile #3", "tile #1", "left/door", "right/door", "square #1",
                                               "square #2"}));
}

TEST(GltfNodes, HiddenNodesAreLeftOutWithAllBelow) {
    GltfFile file = rich_file();
    file.root["extensionsUsed"].push_back("KHR_node_visibility");
    file.root["extensionsRequired"] = {"KHR_node_visibility"};
    const auto hide = [](bool visible) -> json { return {{"KHR_node_visibility", {{"visible", visible}}}}; };
    file.root["nodes"][3]["extensions"] = hide(true);
    EXPECT_EQ(scene_of_gltf(file).objects.size(), 4u);
    file.root["nodes"][3]["extensions"] = hide(false);
    EXPECT_EQ(scene_of_gltf(file).objects.size(), 1u);
    EXPECT_EQ(scene_of_gltf(file).lights.size(), 3u);
    EXPECT_TRUE(says(warnings_of(file), "nodes: 1 hidden by KHR_node_visibility"));
    file.root["nodes"][5]["extensions"]["KHR_node_visibility"]["visible"] = false;
    EXPECT_EQ(scene_of_gltf(file).lights.size(), 2u);
}

/// The square with a skin of two joints: the left half follows the first, the right half the second.
GltfFile skinned_square() {
    GltfFile file = square_file();
    json& attributes = primitive_of(file)["attributes"];
    attributes["JOINTS_0"] =
        file.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 4);
    attributes["WEIGHTS_0"] =
        file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}, 4);
    // Bind matrices invert the joints' rest transforms: the first at z = 1.
    std::vector<float> bind(32, 0.0f);
    for (const std::size_t k : {0, 5, 10, 15}) bind[k] = bind[16 + k] = 1;
    bind[14] = -1;
    const auto matrices = file.accessor(bind, 4);
    file.root["accessors"][matrices]["type"] = "MAT4";
    file.root["accessors"][matrices]["count"] = 2;
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", matrices}});
    file.root["nodes"][0]["skin"] = 0;
    file.root["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
    file.add("nodes", {{"name", "left"}, {"translation", {0, 0, 1}}});
    file.add("nodes", {{"name", "right"}, {"translation", {0, 0, 4}}, {"scale", {2, 2, 2}}});
    file.root["scenes"][0]["nodes"] = {0, 1, 2};
    return file;
}

/// glTF 3.7.3.3: a vertex of a skin is the sum of w_k W_k IBM_k v; the node's own transform is ignored.
TEST(GltfNodes, SkinsAreReadInTheirRestPose) {
    const Scene scene = scene_of_gltf(skinned_square());
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].world_from_object.rows, Transform{}.rows);
    // Joint 1 is the identity here; joint 2 doubles and lifts by 4; corner 2 is half of each: its first weight belongs
    // to joint 1.
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<Vec3>{{0, 0, 0}, {2, 0, 4}, {1.5f, 1.5f, 2}, {0, 1, 0}}));
    EXPECT_TRUE(says(warnings_of(skinned_square()), "skins: 1 read in their rest pose"));
}

TEST(GltfNodes, SkinnedNormalsAndFrontsFollow) {
    GltfFile file = skinned_square();
    file.root["nodes"][1]["scale"] = {-1, 1, 1};
    file.root["skins"][0] = {{"joints", {1, 1}}};
    primitive_of(file)["attributes"]["NORMAL"] =
        file.accessor(std::vector<float>{0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f}, 3);
    const Scene scene = scene_of_gltf(file);
    for (const Vec3 n : scene.meshes[0].normals) EXPECT_LE(length(n - Vec3{-0.6f, 0, 0.8f}), 1e-6f);
    const World world = make_world(scene);
    for (std::size_t t = 0; t < 2; ++t) EXPECT_EQ(world.face_normal(t), (Vec3{0, 0, 1}));
}

TEST(GltfNodes, BadSkinsAreRefused) {
    const auto error_with = [](const std::function<void(GltfFile&)>& spoil) {
        GltfFile file = skinned_square();
        spoil(file);
        return gltf_error(file.glb());
    };
    EXPECT_TRUE(says(error_with([](GltfFile& f) { f.root["nodes"][0]["skin"] = 1; }), "nodes[0].skin: 1 of 1"));
    EXPECT_TRUE(says(error_with([](GltfFile& f) { f.root["skins"][0]["joints"] = {1, 9}; }), "joints[1]: 9 of 3"));
    EXPECT_TRUE(says(error_with([](GltfFile& f) { f.root["skins"][0]["joints"] = {1}; }), "of joint 1 of 1"));
    EXPECT_TRUE(says(error_with([](GltfFile& f) { primitive_of(f)["attributes"].erase("WEIGHTS_0"); }),
                     "meshes[0].primitives[0].attributes: no JOINTS_0"));
    EXPECT_TRUE(says(error_with([](GltfFile& f) { f.root["skins"][0]["inverseBindMatrices"] = 0; }),
                     "skins[0].inverseBindMatrices: not a MAT4 for each of 2 joints"));
}

TEST(GltfNodes, MorphTargetsAreReadAtTheirDefaultWeights) {
    GltfFile file = square_file();
    const auto lift = file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const auto shift = file.accessor(std::vector<float>{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
    primitive_of(file)["targets"] = {{{"POSITION", lift}}, {{"POSITION", shift}}};
    EXPECT_EQ(warnings_of(file), "");
    EXPECT_EQ(scene_of_gltf(file).meshes[0].positions[0], (Vec3{0, 0, 0}));
    file.root["meshes"][0]["weights"] = {0.5, 2};
    EXPECT_EQ(scene_of_gltf(file).meshes[0].positions[0], (Vec3{2, 0, 0.5f}));
    EXPECT_TRUE(says(warnings_of(file), "morph targets at their default weights"));
    // A node's weights replace the mesh's; nodes of the same mesh may differ.
    file.add("nodes", {{"mesh", 0}, {"weights", {0.25, 0}}});
    file.root["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = scene_of_gltf(file);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[scene.objects[0].mesh].positions[0], (Vec3{2, 0, 0.5f}));
    EXPECT_EQ(scene.meshes[scene.objects[1].mesh].positions[0], (Vec3{0, 0, 0.25f}));
}

/// Far from the origin, floats are too far apart: such scenes are moved near zero, and written back to their place.
TEST(GltfNodes, FarScenesAreMovedToTheOrigin) {
    GltfFile file = square_file();
    file.root["nodes"][0] = {{"translation", {6378000.25, 0, 0}}, {"children", {1}}};
    file.add("nodes", {{"mesh", 0}, {"translation", {0.5, 0.03, 0}}});
    const Scene scene = scene_of_gltf(file);
    EXPECT_EQ(scene.origin, (std::array<double, 3>{6378001, 0, 0}));
    EXPECT_EQ(scene.objects[0].world_from_object.translation, (Vec3{-0.25f, 0.03f, 0}));
    EXPECT_TRUE(says(warnings_of(file), "lies 6378 km from its origin, where floats are 0.5 m apart"));
    const auto again = read_gltf_text(encode_glb(scene).value());
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->scene.origin, scene.origin);
    EXPECT_EQ(again->scene.objects[0].world_from_object.translation, scene.objects[0].world_from_object.translation);

    // A scene that is as large as its distance is not moved.
    file.root["nodes"][1]["scale"] = {1e6, 1e6, 1e6};
    EXPECT_EQ(scene_of_gltf(file).origin, Scene{}.origin);
    // Positions that are far within their own mesh have already lost their precision.
    GltfFile stored = square_file();
    primitive_of(stored)["attributes"]["POSITION"] =
        stored.accessor(std::vector<float>{6378000, 0, 0, 6378001, 0, 0, 6378001, 1, 0, 6378000, 1, 0}, 3);
    EXPECT_TRUE(says(warnings_of(stored), "meshes[0]: its positions lie 6.378e+06 m from its origin"));
}

// ---------------------------------------------------------------------------------------------- lights, materials

TEST(GltfLights, EqualConeAnglesMakeAHardEdge) {
    const auto spot = [](double inner, double outer) -> json {
        return {{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}};
    };
    // As written by three.js by default, and pi / 2 as a float.
    for (const auto& [inner, outer] : {std::pair{0.5, 0.5},
                                       {1.0471975511965976, 1.0471975511965976},
                                       {1.57079637, 1.57079637},
                                       {0.0, 1.5707963705062866}}) {
        const Scene scene = scene_of_gltf(with_light(spot(inner, outer)));
        ASSERT_EQ(scene.lights.size(), 1u);
        EXPECT_TRUE(check_scene(scene));
        EXPECT_FLOAT_EQ(scene.lights[0].outer_angle, static_cast<float>(outer));
        EXPECT_FLOAT_EQ(scene.lights[0].inner_angle, static_cast<float>(inner));
        EXPECT_LE(scene.lights[0].inner_angle, scene.lights[0].outer_angle);
    }
    for (const auto& [inner, outer] : {std::pair{0.6, 0.5}, {0.0, 0.0}, {0.1, 1.6}, {-0.1, 0.5}})
        EXPECT_TRUE(says(gltf_error(with_light(spot(inner, outer)).glb()), "lights[0].spot: 0 <= innerConeAngle"));
}

TEST(GltfLights, AmountsBeyondTheLimitOfEnvironmentsAreRefused) {
    EXPECT_EQ(gltf_error(with_light({{"type", "point"}, {"intensity", 1e15}}).glb()), "read without an error");
    for (const double bad : {1.1e15, 3e38, 1e300, -1.0})
        EXPECT_TRUE(
            says(gltf_error(with_light({{"type", "point"}, {"intensity", bad}}).glb()), "lights[0]: its intensity ("))
            << bad;
    GltfFile file = square_file();
    file.add("materials", {{"emissiveFactor", {1, 1, 1}}});
    primitive_of(file)["material"] = 0;
    const auto strength = [&](double value) {
        file.root["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = value;
        return gltf_error(file.glb());
    };
    EXPECT_EQ(strength(1e15), "read without an error");
    EXPECT_TRUE(says(strength(3e38), "materials[0]: its emission (3e+38, 3e+38, 3e+38) is negative or above 1e+15"));
    EXPECT_TRUE(says(strength(-1), "negative or above"));
    Scene scene = scene_of_gltf(square_file());
    scene.materials[0].emission = {3e38f, 0, 0};
    EXPECT_FALSE(check_scene(scene));
}

TEST(GltfMaterials, SpecularGlossinessNamesTheRemedy) {
    GltfFile file = square_file();
    file.add("materials",
             {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 0, 0, 1}}}}}}});
    primitive_of(file)["material"] = 0;
    EXPECT_TRUE(says(gltf_error(file.glb()), "materials[0]: KHR_materials_pbrSpecularGlossiness is not supported"));
    EXPECT_TRUE(says(gltf_error(file.glb()), "gltf-transform metalrough IN.glb OUT.glb"));
}

/// The square with a base colour texture.
GltfFile textured_square(const json& texture, const json& sampler = json::object()) {
    GltfFile file = square_file();
    primitive_of(file)["attributes"]["TEXCOORD_0"] = file.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 2);
    primitive_of(file)["material"] = file.add(
        "materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", file.add("textures", texture)}}}}}});
    file.add("images", {{"bufferView", file.view(small_png())}, {"mimeType", "image/png"}});
    file.add("samplers", sampler);
    return file;
}

TEST(GltfMaterials, TexturesMayHaveNoImage) {
    const GltfFile file = textured_square({{"sampler", 0}});
    const Scene scene = scene_of_gltf(file);
    EXPECT_TRUE(scene.textures.empty());
    EXPECT_FALSE(scene.materials[0].base_color_texture);
    EXPECT_TRUE(says(warnings_of(file), "textures[0]: no image; left out"));
}

/// A texture whose only image comes from an extension is read, or refused like a missing file: it may light the scene.
TEST(GltfMaterials, ImagesOfExtensionsAreNotDropped) {
    EXPECT_EQ(scene_of_gltf(textured_square({{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}})).textures.size(),
              1u);
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
        const GltfFile file = textured_square({{"extensions", {{name, {{"source", 0}}}}}});
        EXPECT_TRUE(says(gltf_error(file.glb()), std::string("textures[0]: its only image is in ") + name));
    }
}

TEST(GltfMaterials, SamplersChooseTheFilter) {
    const auto filter = [](const json& sampler) {
        return scene_of_gltf(textured_square({{"source", 0}, {"sampler", 0}}, sampler)).textures.at(0).filter;
    };
    EXPECT_EQ(filter(json::object()), Texture::Filter::linear);
    EXPECT_EQ(filter({{"magFilter", 9729}}), Texture::Filter::linear);
    EXPECT_EQ(filter({{"magFilter", 9728}, {"minFilter", 9984}}), Texture::Filter::nearest);
    const GltfFile bad = textured_square({{"source", 0}, {"sampler", 0}}, {{"magFilter", 9984}});
    EXPECT_TRUE(says(gltf_error(bad.glb()), "samplers[0].magFilter: neither NEAREST nor LINEAR"));
}

/// The original files of these tests, if the folder of cases is present.
TEST(GltfCases, SharedFilesAreReadOrRefusedAsTheyShould) {
    const std::filesystem::path folder = test::cases_folder();
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no " << folder;
    const auto outcome = [&](const char* name) {
        const auto loaded = read_gltf(folder / name);
        return loaded ? std::string("read") : loaded.error().message;
    };
    for (const char* good :
         {"d02-spot-0.5-0.5.glb", "d02-three-default-spotlight.glb", "d07-ecef-room-6378000.glb",
          "d19-sparse-indices.glb", "o02-integers-as-floats.gltf", "o03-no-position.glb",
          "o04-texture-without-source.glb", "o21-duplicate-names.glb", "o50-hand-skinned-roof.glb",
          "o60-texture-on-uv1.glb", "o61-nearest.glb", "o65-uv1-partly.glb", "o80-emissive-webp-ext-only.glb"})
        EXPECT_EQ(outcome(good), "read") << good;
    EXPECT_TRUE(says(outcome("o01-specgloss.glb"), "gltf-transform metalrough"));
    EXPECT_TRUE(says(outcome("o20-emission-3e38.glb"), "negative or above 1e+15"));
    EXPECT_TRUE(says(outcome("o41-minVersion-2.1.glb"), "asset.minVersion"));
}

}  // namespace
}  // namespace lobelia
