// Tests that bad glTF files are refused with the place of the error, and that nothing outside the scene's folder is
// read.
#include <unistd.h>

#include <fstream>

#include "data.h"
#include "gltf_reading.h"
#include "io/read_picture.h"
#include "picture_files.h"
#include "same_scenes.h"
#include "scene/gltf/gather.h"

namespace lobelia {
namespace {

using nlohmann::json;
using test::expect_same;
using test::gltf_error;
using test::read_gltf_text;
using test::says;
using test::scene_of_gltf;

TEST(BadGltf, ContainerIsNamed) {
    EXPECT_TRUE(says(gltf_error(""), "test.glb: the file is empty"));
    EXPECT_TRUE(says(gltf_error("hello"), "neither a .glb nor a .gltf"));
    EXPECT_TRUE(says(gltf_error("{\"asset\":"), "test.glb: invalid JSON at byte"));
    EXPECT_TRUE(says(gltf_error("{}"), "asset.version: missing"));
    EXPECT_TRUE(says(gltf_error(R"({"asset":{"version":"1.0"}})"), "glTF \"1.0\" is not supported"));
    EXPECT_TRUE(says(gltf_error(R"({"asset":{"version":"2.0"},"nodes":7})"), "nodes: not an array"));
    EXPECT_TRUE(says(gltf_error(R"({"asset":{"version":"2.0"},"nodes":[7]})"), "nodes[0]: not an object"));
    EXPECT_TRUE(says(gltf_error(std::string(10000, '[') + "]"), "neither a .glb"));
    EXPECT_TRUE(says(gltf_error("{\"a\":" + std::string(100000, '[')), "nests more than 64 levels"));
    const std::string glb = square_file().glb();
    EXPECT_TRUE(says(gltf_error(glb.substr(0, glb.size() - 8)), "truncated"));
    std::string version = glb;
    version[4] = 1;
    EXPECT_TRUE(says(gltf_error(version), "GLB version 1 is not supported"));
}

/// A file cut off anywhere gives an error and nothing worse.
TEST(BadGltf, EveryTruncationIsRefused) {
    for (const std::string& whole : {rich_file().glb(), rich_file().gltf()})
        for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + size / 64)
            EXPECT_FALSE(read_gltf_text(whole.substr(0, size))) << size;
}

/// Spoils one thing in a rich file and expects the message to name it.
void expect_error(std::string_view message, const std::function<void(GltfFile&)>& spoil,
                  const GltfReadOptions& options = {}) {
    GltfFile file = rich_file();
    spoil(file);
    EXPECT_TRUE(says(gltf_error(file.glb(), options), message));
    EXPECT_TRUE(says(gltf_error(file.gltf(), options), message));
}

TEST(BadGltf, PlaceIsNamed) {
    using F = GltfFile;
    const auto primitive = [](F& f) -> json& { return f.root["meshes"][0]["primitives"][0]; };
    expect_error("meshes[0].primitives[0].attributes.POSITION: accessor 99 of",
                 [&](F& f) { primitive(f)["attributes"]["POSITION"] = 99; });
    expect_error("meshes[0].primitives[0].indices (accessors[1]): 7 elements from byte 0 on exceed the 12 bytes",
                 [](F& f) { f.root["accessors"][1]["count"] = 7; });
    expect_error("meshes[0].primitives[0].indices: element 2 is vertex 2 of 2",
                 [](F& f) { f.root["accessors"][0]["count"] = 2; });
    expect_error("meshes[0].primitives[0].indices: not a whole number", [&](F& f) { primitive(f)["indices"] = -1; });
    expect_error("meshes[0].primitives[0].indices: not unsigned integers", [&](F& f) { primitive(f)["indices"] = 0; });
    expect_error("meshes[0].primitives[0].material: 9 of 2", [&](F& f) { primitive(f)["material"] = 9; });
    expect_error("meshes[0].primitives[0].mode: 9", [&](F& f) { primitive(f)["mode"] = 9; });
    expect_error("accessors[0].count: not a whole number", [](F& f) { f.root["accessors"][0]["count"] = 4.5; });
    expect_error("exceed the 48 bytes", [](F& f) { f.root["accessors"][0]["count"] = 2000000000; });
    expect_error("componentType 5130 is not supported", [](F& f) { f.root["accessors"][0]["componentType"] = 5130; });
    expect_error("matrices are not supported", [](F& f) { f.root["accessors"][0]["type"] = "MAT4"; });
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
    expect_error("nodes[2]: it is one of its own ancestors", [](F& f) {
        f.root["nodes"][3]["children"] = {1};
        f.root["nodes"][2]["children"] = {2};
    });
    expect_error("scenes[0].nodes: nodes[1] is not a root", [](F& f) { f.root["scenes"][0]["nodes"] = {1}; });
    expect_error("scenes[0].nodes: nodes[0] is listed twice", [](F& f) { f.root["scenes"][0]["nodes"] = {0, 0}; });
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

TEST(BadGltf, DamagedTextures) {
    const std::string jpeg = make_jpeg(test_picture(19, 10));
    for (const auto& [bytes, reason] :
         {std::pair{jpeg_without(jpeg, 0xc4), "images[0]: damaged or unsupported JPEG: a scan names a Huffman table"},
          {jpeg_without(jpeg, 0xdb), "images[0]: damaged or unsupported JPEG: "},
          {jpeg.substr(0, jpeg.size() / 2), "images[0]: damaged or unsupported JPEG: the file ends too early"},
          {make_png(19, 10).bytes.substr(0, 90), "images[0]: damaged PNG: the file ends too early"},
          {make_webp(test_picture(19, 10)).substr(0, 60), "images[0]: damaged WebP: "},
          {std::string("BM123456"), "images[0]: a BMP picture is not supported"}})
        expect_error(reason, [&picture = bytes](GltfFile& f) {
            f.root["images"][0]["bufferView"] = f.view(std::string_view(picture));
            f.root["images"][0].erase("mimeType");
        });
    // A scan that names tables which were never defined, in a real file.
    const auto file = test::cases_folder() / "jpeg-oob.glb";
    if (!std::filesystem::exists(file)) return;
    const auto loaded = read_gltf(file);
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(says(loaded.error().message, "JPEG"));
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
    const auto loaded = read_gltf_text(file.glb());
    ASSERT_TRUE(loaded);
    ASSERT_EQ(loaded->warnings.size(), 1u);
    EXPECT_TRUE(says(loaded->warnings[0], "1 triangle without area, the first is meshes[0], triangle 1"));
}

TEST(BadGltf, RequiredExtensionsNameTheRemedy) {
    const auto required = [](const char* name) {
        GltfFile file = square_file();
        file.root["extensionsRequired"] = {name};
        return gltf_error(file.glb());
    };
    EXPECT_TRUE(says(required("KHR_draco_mesh_compression"), "gltf-transform copy IN.glb OUT.glb"));
    EXPECT_TRUE(says(required("EXT_meshopt_compression"), "gltf-transform copy IN.glb OUT.glb"));
    EXPECT_TRUE(says(required("KHR_texture_basisu"), "gltf-transform ktxdecompress"));
    EXPECT_TRUE(says(required("EXT_texture_avif"), "gltf-transform png"));
    EXPECT_EQ(required("EXT_texture_webp"), "read without an error");
    EXPECT_TRUE(says(required("ACME_secret"), "extensionsRequired: ACME_secret is not supported"));
    EXPECT_EQ(required("KHR_mesh_quantization"), "read without an error");
}

/// The compression extension is used but not required: the reader takes the uncompressed data if present.
TEST(BadGltf, CompressedDataWithoutAFallbackNamesTheRemedy) {
    GltfFile file = square_file();
    file.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
    EXPECT_EQ(gltf_error(file.glb()), "read without an error");
    file.root["accessors"][0].erase("bufferView");
    EXPECT_TRUE(says(gltf_error(file.glb()), "meshes[0].primitives[0]: KHR_draco_mesh_compression is not supported"));

    json root = square_file().root;
    root["buffers"] =
        json::array({{{"byteLength", 60}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
    EXPECT_TRUE(says(gltf_error(root.dump()), "bufferViews[0]: EXT_meshopt_compression is not supported"));
}

/// A square of which EXT_mesh_gpu_instancing makes a million copies, by an accessor without data.
GltfFile many_copies() {
    GltfFile file = square_file();
    const std::size_t zeros =
        file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", std::size_t{1} << 20}});
    file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = zeros;
    return file;
}

/// `count` primitives over accessors without data, of a million vertices each.
GltfFile many_zeros(std::size_t count) {
    GltfFile file = square_file();
    const std::size_t zeros =
        file.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", std::size_t{1} << 20}});
    nlohmann::json primitive = {{"attributes", {{"POSITION", zeros}}}};
    file.root["meshes"][0]["primitives"] = nlohmann::json(count, primitive);
    return file;
}

/// A small file asks for a scene of gigabytes, or for hours of reading: refused at once, unless an option allows it.
TEST(BadGltf, SmallFilesGiveSmallScenes) {
    GltfFile morphed = many_zeros(1);
    morphed.root["meshes"][0]["primitives"][0]["targets"] =
        nlohmann::json(4096, {{"POSITION", morphed.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]}});
    morphed.root["meshes"][0]["weights"] = nlohmann::json(4096, 1.0);
    for (const GltfFile& file : {many_copies(), many_zeros(400), morphed}) {
        const std::string bytes = file.glb();
        const auto loaded = read_gltf(std::as_bytes(std::span(bytes)), "small.glb", {});
        ASSERT_FALSE(loaded);
        EXPECT_TRUE(says(loaded.error().message, "--scene-memory")) << loaded.error().message;
    }
    GltfReadOptions options;
    options.scene_memory = std::size_t{1} << 32;
    const std::string bytes = many_copies().glb();
    EXPECT_TRUE(read_gltf(std::as_bytes(std::span(bytes)), "small.glb", {}, options));
    options.scene_memory = 1 << 10;
    const std::string square = square_file().glb();
    EXPECT_FALSE(read_gltf(std::as_bytes(std::span(square)), "small.glb", {}, options));
}

TEST(BadGltf, AStopEndsTheReading) {
    const std::atomic<bool> stop = true;
    GltfReadOptions options;
    options.stop = &stop;
    const std::string bytes = square_file().glb();
    const auto loaded = read_gltf(std::as_bytes(std::span(bytes)), "small.glb", {}, options);
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(says(loaded.error().message, "stopped"));
}

TEST(BadGltf, LimitsHoldBeforeAllocation) {
    GltfReadOptions options;
    options.most_triangles = 5;
    EXPECT_TRUE(says(gltf_error(rich_file().glb(), options), "2 triangles; the limit allows 1 more"));
    options = {};
    options.most_objects = 3;
    EXPECT_TRUE(says(gltf_error(rich_file().glb(), options), "more than 3 objects"));
    options = {};
    options.most_texels = 7;
    EXPECT_TRUE(says(gltf_error(rich_file().glb(), options), "images[1]: the image is 2 x 2 pixels"));
    options = {};
    options.most_bytes = 10;
    EXPECT_TRUE(says(gltf_error(rich_file().gltf(), options), "too large together"));
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

/// What other programs are given holds the files as they were checked, under names that the scene did not choose.
TEST_F(GltfFolder, GatheredFilesNameNothingOutside) {
    buffer("data%20file.bin");
    std::ofstream(folder_ / "scene" / "gathered.gltf") << file_.root.dump();
    const auto gathered = gltf::gather_gltf(folder_ / "scene" / "gathered.gltf", 1 << 20);
    ASSERT_TRUE(gathered) << gathered.error().message;
    const auto document = nlohmann::json::parse(gathered->json);
    std::size_t named = 0;
    for (const char* list : {"buffers", "images"})
        for (const auto& entry : document[list]) {
            if (!entry.contains("uri") || entry["uri"].get<std::string>().starts_with("data:")) continue;
            EXPECT_TRUE(entry["uri"].get<std::string>().starts_with("resource-"));
            ++named;
        }
    EXPECT_EQ(named, gathered->files.size());
    EXPECT_GT(named, 0u);

    std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "scene" / "link.png");
    file_.root["images"][1]["uri"] = "link.png";
    std::ofstream(folder_ / "scene" / "gathered.gltf") << file_.root.dump();
    const auto refused = gltf::gather_gltf(folder_ / "scene" / "gathered.gltf", 1 << 20);
    ASSERT_FALSE(refused);
    EXPECT_TRUE(says(refused.error().message, "leads out of the scene's folder")) << refused.error().message;
}

TEST_F(GltfFolder, ExternalFilesAreRead) {
    EXPECT_EQ(error(), "read without an error");
    const auto loaded = read_gltf(folder_ / "scene" / "scene.gltf");
    expect_same(scene_of_gltf(rich_file()), loaded->scene);
}

TEST_F(GltfFolder, PathsOutOfTheFolderAreRefused) {
    for (const char* uri : {"../secret.bin", "textures/../../secret.bin", "%2e%2e/secret.bin", "..%2fsecret.bin"}) {
        buffer(uri);
        EXPECT_TRUE(says(error(), "buffers[0].uri")) << uri;
        EXPECT_TRUE(says(error(), "leads out of the scene's folder")) << uri;
    }
    for (const char* uri : {"/etc/passwd", "%2Fetc%2Fpasswd"}) {
        buffer(uri);
        EXPECT_TRUE(says(error(), "an absolute path")) << uri;
    }
    for (const char* uri :
         {"file:///etc/passwd", "http://example.org/a.bin", "C:\\a.bin", "a%00.bin", "..\\secret.bin"}) {
        buffer(uri);
        EXPECT_TRUE(says(error(), "only plain relative paths are read")) << uri;
    }
    buffer("a%2.bin");
    EXPECT_TRUE(says(error(), "percent sign"));
    file_.root["images"][1]["uri"] = "../secret.png";
    buffer("data%20file.bin");
    EXPECT_TRUE(says(error(), "images[1].uri: \"../secret.png\" is refused"));
}

/// A path may go up and down again as long as it stays inside.
TEST_F(GltfFolder, PathsThatComeBackAreRead) {
    for (const char* uri : {"textures/../textures/a.png", "./textures/./a.png", "textures%2F..%2Ftextures/a.png"}) {
        file_.root["images"][1]["uri"] = uri;
        EXPECT_EQ(error(), "read without an error") << uri;
    }
    for (const char* uri : {"textures/../../scene/textures/a.png", "textures/../.."}) {
        file_.root["images"][1]["uri"] = uri;
        EXPECT_TRUE(says(error(), "leads out of the scene's folder")) << uri;
    }
}

TEST_F(GltfFolder, LinksOutOfTheFolderAreRefused) {
    std::filesystem::create_symlink(folder_ / "secret.bin", folder_ / "scene" / "link.bin");
    std::filesystem::create_directory_symlink(folder_, folder_ / "scene" / "up");
    std::filesystem::create_symlink("data file.bin", folder_ / "scene" / "inner.bin");
    for (const char* uri : {"link.bin", "up/secret.bin"}) {
        buffer(uri);
        EXPECT_TRUE(says(error(), "leads out of the scene's folder")) << uri;
    }
    buffer("inner.bin");
    EXPECT_EQ(error(), "read without an error");
}

TEST_F(GltfFolder, MissingAndShortFilesAreNamed) {
    buffer("gone.bin");
    EXPECT_TRUE(says(error(), "buffers[0].uri"));
    EXPECT_TRUE(says(error(), "gone.bin: No such file"));
    buffer("textures");
    EXPECT_TRUE(says(error(), "not a regular file"));
    buffer("textures/a.png");
    EXPECT_TRUE(says(error(), "but byteLength is"));
    EXPECT_TRUE(says(read_gltf(folder_ / "no.glb").error().message, "no.glb: cannot be read: No such file"));
    EXPECT_TRUE(says(read_gltf(folder_).error().message, "not a regular file"));
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
