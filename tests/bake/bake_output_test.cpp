// Tests that a written bake reads back equal, and that damaged or foreign files are refused.
#include <sys/stat.h>

#include <gtest/gtest.h>

#include "bake/write/manifest.h"
#include "bake/write/page_files.h"
#include "bake/write/probe_files.h"
#include "bake_files.h"
#include "folders.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;
using test::some_bake;

class BakeOutput : public ::testing::Test {
  protected:
    BakeOutput()
        : folder_(std::string("bake-output-") + ::testing::UnitTest::GetInstance()->current_test_info()->name()) {}
    [[nodiscard]] fs::path path() const { return folder_.path() / "bake"; }
    [[nodiscard]] std::string message() const {
        const auto bake = read_bake(path());
        return bake ? "" : bake.error().message;
    }
    test::TestFolder folder_;
};

void expect_equal(const AtlasPlacement& a, const AtlasPlacement& b) {
    EXPECT_EQ(a.baked, b.baked);
    EXPECT_EQ(a.page, b.page);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.offset, b.offset);
    EXPECT_EQ(a.texels.x0, b.texels.x0);
    EXPECT_EQ(a.texels.y0, b.texels.y0);
    EXPECT_EQ(a.texels.x1, b.texels.x1);
    EXPECT_EQ(a.texels.y1, b.texels.y1);
}

TEST_F(BakeOutput, RoundTripOfManifest) {
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(path(), bake));
    const auto read = read_manifest(path());
    ASSERT_TRUE(read) << read.error().message;
    const Manifest &a = bake.manifest, &b = *read;
    EXPECT_EQ(a.program, b.program);
    EXPECT_EQ(a.scene_name, b.scene_name);
    EXPECT_EQ(a.scene_hash, b.scene_hash);
    EXPECT_EQ(a.coefficients, b.coefficients);
    ASSERT_EQ(b.pages.size(), 2u);
    EXPECT_EQ(b.pages[1].file, "page-1.exr");
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
        EXPECT_EQ(a.objects[i].name, b.objects[i].name);
        expect_equal(a.objects[i].placement, b.objects[i].placement);
    }
    // The text holds everything else, and writing it again gives the same text.
    EXPECT_EQ(to_json_text(b), test::contents(path() / "bake.json"));
    EXPECT_EQ(b.options.paths.seed, 0xfffffffeu);
    EXPECT_EQ(b.options.target_error, 0.125);
    EXPECT_EQ(b.options.most_seconds, std::nullopt);
    EXPECT_EQ(b.options.shard.count, 5u);
    EXPECT_EQ(b.finish, a.finish);
    EXPECT_EQ(b.warnings, a.warnings);
    EXPECT_EQ(b.statistics.rays, 123456789012345u);
}

TEST_F(BakeOutput, RoundTripOfPages) {
    for (const char* codec : {"sh1/moments/convolution", "sg12h/moments/exact", "sh8/projection/convolution"}) {
        const Bake bake = some_bake(codec, Frame::tangent);
        ASSERT_TRUE(write_bake(path(), bake));
        const auto read = read_bake(path());
        ASSERT_TRUE(read) << read.error().message;
        ASSERT_EQ(read->pages.size(), 2u);
        for (std::size_t p = 0; p < 2; ++p) {
            EXPECT_EQ(read->pages[p].planes, bake.pages[p].planes);
            EXPECT_EQ(read->pages[p].chart, bake.pages[p].chart);
            EXPECT_EQ(read->pages[p].validity, bake.pages[p].validity);
            EXPECT_EQ(read->normals[p], bake.normals[p]);
        }
    }
}

TEST_F(BakeOutput, HalfPagesKeepElevenBits) {
    Bake bake = some_bake("sh1/moments/convolution");
    bake.manifest.precision = Precision::half;
    bake.pages[0].chart[3] = 1u << 24;
    ASSERT_TRUE(write_bake(path(), bake));
    const auto read = read_bake(path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->pages[0].chart, bake.pages[0].chart);
    for (std::size_t i = 0; i < bake.pages[0].size(); ++i) {
        const float value = bake.pages[0].planes[7][i];
        EXPECT_NEAR(read->pages[0].planes[7][i], value, std::abs(value) / 2048 + 1e-7f);
        const Vec3 n = bake.normals[0][i];
        EXPECT_NEAR(length(read->normals[0][i]), length(n), 1e-6f);
        EXPECT_GE(dot(read->normals[0][i], n), dot(n, n) - 1e-6f);
    }
}

TEST_F(BakeOutput, RoundTripOfProbes) {
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(path(), bake));
    const auto read = read_bake(path());
    ASSERT_TRUE(read && read->probes);
    const ProbeSet &a = *bake.probes, &b = *read->probes;
    EXPECT_EQ(a.codec, b.codec);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.validity, b.validity);
    EXPECT_EQ(a.back_faces, b.back_faces);
    EXPECT_EQ(a.coefficients, b.coefficients);
    ASSERT_TRUE(b.grid);
    EXPECT_EQ(a.grid->count, b.grid->count);
    EXPECT_EQ(a.grid->origin, b.grid->origin);
    ASSERT_EQ(b.cells.size(), 1u);
    EXPECT_EQ(a.cells[0].corners, b.cells[0].corners);
}

TEST_F(BakeOutput, HostileManifestsAreRefusedWithTheirPlace) {
    ASSERT_TRUE(write_bake(path(), some_bake("sh1/moments/convolution")));
    const std::string good = test::contents(path() / "bake.json");
    struct Case {
        std::string from, to, says;
    };
    const std::vector<Case> cases = {
        {"\"lobelia_bake\": 3", "\"lobelia_bake\": 1",
         "lobelia_bake: version 1, but this program reads versions 2 to 3"},
        {"\"lobelia_bake\": 3", "\"lobelia\": 1", "is it from `lobelia bake`?"},
        {"0123456789abcdef", "0123456789abcdeg", "scene.hash: not 16 hexadecimal digits"},
        {"sh1/moments/convolution", "sh1/moments/none", "codec.name: unknown evaluator"},
        {"sh1/moments/convolution", "sg12h/moments/exact", "codec.coefficients: sg12h has 12"},
        {"\"coefficients\": 4", "\"coefficients\": 5", "codec.coefficients: sh1 has 4 coefficients"},
        {"\"width\": 21", "\"width\": 0", "layout.width: not a whole number from 1 to 65536"},
        {"\"width\": 21", "\"width\": 21.5", "layout.width"},
        {"\"width\": 21", "\"width\": 22", "the manifest says 22 x 34"},
        {"\"c3.G\"", "\"c3.Q\"", "layout.channels[10]: not \"c3.G\""},
        {"page-1.exr", "../page-1.exr", "layout.pages[1].file: not the name of a file"},
        {"page-1.exr", "..", "layout.pages[1].file: not the name of a file"},
        {"page-1.exr", "C:page.exr", "layout.pages[1].file: not the name of a file"},
        {"page-1.exr", "page-0.exr", "named twice"},
        {"\"float16\"", "\"flaot16\"", "layout.pages[0].textures[0].storage: unknown storage \"flaot16\""},
        {"\"name\": \"v1\"", "\"name\": \"v3\"", "textures[1].name: no texture of the storage float16"},
        {"\"rgba16f\"", "\"rgba8\"", "layout.pages[0].textures[0].format: not \"rgba16f\""},
        {"\"vk_format\": 97", "\"vk_format\": 37", "layout.pages[0].textures[0].vk_format: not 97"},
        {"\"coefficient\": 1", "\"coefficient\": 2", "layout.pages[0].textures[0].channels[3].coefficient: not 1"},
        {"\"offset\": 0.5", "\"offset\": 0.25", "layout.pages[0].textures[4].channels[0].offset: not 0.5"},
        {"\"scale\": 1.0", "\"scale\": 0.0", "layout.pages[0].textures[0].scale: 0 is not in"},
        {"\"layer\": 1", "\"layer\": 0", "layer 0 of the file page-0.float16.rgba16f.ktx2 is named twice"},
        {"\"layer\": 1", "\"layer\": -1", "layout.pages[0].textures[1].layer: not a whole number"},
        {"page-0.ratio8.c0.ktx2", "page-1.exr", "the file page-1.exr is named twice"},
        {"page-0.validity.ktx2", "a/b", "layout.pages[0].validity: not the name of a file"},
        {"page-1.exr", "page-9.exr", "page-9.exr: cannot be read"},
        {"probes.json", "bake.jsonn", "bake.jsonn: cannot be read: No such file"},
        {"\"page\": 1", "\"page\": 2", "objects[2].page: not a whole number from 0 to 1"},
        {"\"page\": 1", "\"page\": -1", "objects[2].page"},
        {"\"seconds\": 1.5", "\"seconds\": 1e999", "beyond double precision"},
        {"\"seconds\": 1.5", "\"seconds\": \"1.5\"", "statistics.seconds: not a finite number"},
        {"\"by\": \"samples\"", "\"by\": \"magic\"", "options.shard.by: \"magic\" is none of tiles, samples"},
        {"\"count\": 5", "\"count\": 0", "options.shard.count"},
        {"\"crc32\": \"", "\"crc32\": \"z", "files[0].crc32: not 8 hexadecimal digits"},
        {"\"size\": ", "\"size\": -", "files[0].size"},
        {"{", "[{", "invalid JSON at byte"},
        {"\"frame\"", "\"name\": 1, \"frame\"", "duplicate key \"name\""},
    };
    for (const auto& c : cases) {
        std::string text = good;
        const auto found = text.find(c.from);
        ASSERT_NE(found, std::string::npos) << c.from;
        test::overwrite(path() / "bake.json", text.replace(found, c.from.size(), c.to));
        EXPECT_NE(message().find(c.says), std::string::npos) << c.to << " says: " << message();
        EXPECT_NE(message().find(path().string()), std::string::npos) << message();
    }
}

TEST_F(BakeOutput, FilesOfVersion2AreRead) {
    // Its textures were files of their own, without a layer.
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(path(), bake, {.textures = {.storages = {{"float16"}}, .arrays = Switch::off}}));
    std::string text = test::contents(path() / "bake.json");
    const std::string version = "\"lobelia_bake\": 3";
    const auto found = text.find(version);
    ASSERT_NE(found, std::string::npos);
    ASSERT_EQ(text.find("\"layer\""), std::string::npos);
    test::overwrite(path() / "bake.json", text.replace(found, version.size(), "\"lobelia_bake\": 2"));
    const auto read = read_bake(path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->pages[1].planes, bake.pages[1].planes);
    ASSERT_EQ(read->manifest.pages[0].textures.size(), 3u);
    EXPECT_EQ(read->manifest.pages[0].textures[1].file, "page-0.float16.v1.ktx2");
}

TEST_F(BakeOutput, TruncatedFilesAreRefused) {
    ASSERT_TRUE(write_bake(path(), some_bake("sh1/moments/convolution")));
    for (const char* name : {"bake.json", "probes.json", "probes.bin", "page-1.exr"}) {
        const std::string whole = test::contents(path() / name);
        for (std::size_t part = 0; part < 16; ++part) {
            test::overwrite(path() / name, whole.substr(0, whole.size() * part / 16));
            EXPECT_NE(message().find(name), std::string::npos) << name << " " << part << ": " << message();
        }
        test::overwrite(path() / name, whole);
    }
    EXPECT_EQ(message(), "");
}

TEST_F(BakeOutput, DeepNestingIsRefused) {
    fs::create_directories(path());
    test::overwrite(path() / "bake.json", std::string(1 << 20, '['));
    EXPECT_NE(message().find("nests more than 64 levels deep"), std::string::npos);
    std::string nested = "{\"lobelia_bake\":";
    nested += std::string(1 << 18, '[') + std::string(1 << 18, ']') + "}";
    test::overwrite(path() / "bake.json", nested);
    EXPECT_NE(message().find("nests more than 64 levels deep"), std::string::npos) << message();
}

TEST_F(BakeOutput, PagesWithoutMeaningAreRefused) {
    // Such values are not written: put pages and probes that hold them into the place of good ones.
    const auto with = [&](const auto& change) {
        Bake bake = some_bake("sh1/moments/convolution");
        EXPECT_TRUE(write_bake(path(), bake));
        auto manifest = read_manifest(path());
        manifest->files.clear();
        test::overwrite(path() / "bake.json", to_json_text(*manifest));
        change(bake);
        for (std::size_t p = 0; p < bake.pages.size(); ++p) {
            auto file = StagedFile::create(path() / manifest->pages[p].file);
            EXPECT_TRUE(write_page(*file, bake.pages[p], bake.channels(), bake.normals[p]) && file->flush() &&
                        file->commit());
        }
        const std::vector<Rgb>& c = bake.probes->coefficients;
        test::overwrite(path() / "probes.bin",
                        std::string(reinterpret_cast<const char*>(c.data()), c.size() * sizeof(Rgb)));
        return message();
    };
    EXPECT_NE(with([](Bake& b) { b.pages[0].planes[5][1 + 2 * 21] = NAN; }).find("channel c1.B, x = 1, y = 2"),
              std::string::npos);
    EXPECT_NE(with([](Bake& b) { b.pages[1].validity[0] = 1.5f; }).find("validity, x = 0, y = 0: 1.5 is not in [0, 1]"),
              std::string::npos);
    EXPECT_NE(with([](Bake& b) { b.normals[0][0].x = INFINITY; }).find("channel N.x"), std::string::npos);
    EXPECT_NE(with([](Bake& b) { b.probes->coefficients[5].g = NAN; }).find("coefficient 1 of probe 1"),
              std::string::npos);
}

TEST_F(BakeOutput, ValuesThatAreNotFiniteAreNotWritten) {
    const auto refused = [&](const auto& change) {
        Bake bake = some_bake("sh1/moments/convolution");
        change(bake);
        const auto written = write_bake(path(), bake);
        return !written && !fs::exists(path() / "bake.json");
    };
    EXPECT_TRUE(refused([](Bake& b) { b.pages[0].planes[5][1 + 2 * 21] = NAN; }));
    EXPECT_TRUE(refused([](Bake& b) { b.pages[0].planes[0][0] = INFINITY; }));
    EXPECT_TRUE(refused([](Bake& b) { b.probes->coefficients[5].g = NAN; }));
}

TEST_F(BakeOutput, TooManyChartsAreAnErrorAndNothingChanges) {
    const Bake good = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(path(), good));
    const std::string manifest = test::contents(path() / "bake.json");
    Bake bad = good;
    bad.manifest.scene_name = "another";
    bad.pages[1].chart[0] = (1u << 24) + 1;
    EXPECT_FALSE(write_bake(path(), bad));
    EXPECT_EQ(test::contents(path() / "bake.json"), manifest);
    EXPECT_FALSE(write_bake(folder_.path() / "new", bad));
    EXPECT_EQ(folder_.entries(), 1u);
}

TEST(BakeFolder, LightBeyondHalfIsWrittenAsFloat) {
    const test::TestFolder folder("bake-bright");
    Bake bake = test::some_bake("sh1/moments/convolution");
    bake.manifest.precision = Precision::half;
    bake.pages[0].planes[2][1] = 1e6f;
    const auto manifest = write_bake(folder.path(), bake);
    ASSERT_TRUE(manifest) << manifest.error().message;
    EXPECT_EQ(manifest->precision, Precision::full);
    EXPECT_NE(manifest->warnings.back().find("1e+06 exceed the range of half"), std::string::npos);
    const auto read = read_bake(folder.path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->pages[0].planes[2][1], 1e6f);
    bake.pages[0].planes[2][1] = 65504;
    EXPECT_EQ(write_bake(folder.path(), bake)->precision, Precision::half);
}

/// Half floats end at 6e-8: dim light would lose its steps, or vanish.
TEST(BakeFolder, DimPagesAreWrittenAsFloats) {
    const test::TestFolder folder("bake-dim");
    Bake bake = test::some_bake("sh1/moments/convolution");
    bake.manifest.precision = Precision::half;
    for (LightmapPage& page : bake.pages)
        for (auto& plane : page.planes) std::fill(plane.begin(), plane.end(), 3e-8f);
    const auto manifest = write_bake(folder.path(), bake);
    ASSERT_TRUE(manifest) << manifest.error().message;
    EXPECT_EQ(manifest->precision, Precision::full);
    EXPECT_NE(manifest->warnings.back().find("half floats end at 6e-8"), std::string::npos);
    for (const TextureEntry& texture : manifest->pages[0].textures)
        EXPECT_TRUE(texture.storage != "float16" || texture.scale < 1e-6f) << texture.scale;
    const auto read = read_bake(folder.path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->pages[0].planes[2][1], 3e-8f);
}

/// Whoever fills a folder must not choose what is read: no file of it is a link or a pipe.
TEST(BakeFolder, LinksAndPipesAreRefused) {
    const test::TestFolder folder("bake-links");
    const auto whole = folder.path() / "whole", other = folder.path() / "other";
    ASSERT_TRUE(write_bake(whole, test::some_bake("sh1/moments/convolution")));
    ASSERT_TRUE(read_bake(whole));
    for (const char* name : {"bake.json", "page-1.exr", "probes.json", "probes.bin"}) {
        std::filesystem::rename(whole / name, other);
        std::filesystem::create_symlink(other, whole / name);
        auto read = read_bake(whole);
        ASSERT_FALSE(read) << name;
        EXPECT_NE(read.error().message.find("symbolic link"), std::string::npos) << read.error().message;
        std::filesystem::remove(whole / name);
        ASSERT_EQ(::mkfifo((whole / name).c_str(), 0600), 0);
        read = read_bake(whole);
        ASSERT_FALSE(read) << name;
        EXPECT_NE(read.error().message.find("pipe"), std::string::npos) << read.error().message;
        std::filesystem::remove(whole / name);
        std::filesystem::rename(other, whole / name);
    }
}

TEST(BakeFolder, NothingThatIsNotFiniteIsWritten) {
    const test::TestFolder folder("bake-nan");
    for (const float bad : {NAN, INFINITY}) {
        Bake bake = test::some_bake("sh1/moments/convolution");
        bake.pages[1].planes[3][22] = bad;
        const auto written = write_bake(folder.path() / "new", bake);
        ASSERT_FALSE(written);
        EXPECT_NE(written.error().message.find("page 1, channel c1.R, x = 1, y = 1"), std::string::npos);
        EXPECT_EQ(folder.entries(), 0u);
        bake.pages[1].planes[3][22] = 0;
        bake.probes->coefficients[3].g = bad;
        EXPECT_FALSE(write_bake(folder.path() / "new", bake));
        EXPECT_EQ(folder.entries(), 0u);
    }
}

TEST(Manifest, NamesOfCodecsOpenNoFiles) {
    const test::TestFolder folder("bake-hostile");
    test::overwrite(folder.path() / "lobes.txt", "0 0 1 2\n1 0 0 2\n");
    for (const std::string& file : {(folder.path() / "lobes.txt").string(), std::string("/dev/zero")})
        for (const std::string& prefix : {std::string("sg:"), std::string("sgh:")}) {
            Bake bake = test::some_bake("sh1/moments/convolution");
            std::string text = to_json_text(bake.manifest);
            const std::string name = "sh1/moments/convolution";
            text.replace(text.find(name), name.size(), prefix + file + "/moments/exact");
            const auto manifest = manifest_from_json(text, "bake.json");
            ASSERT_FALSE(manifest);
            EXPECT_NE(manifest.error().message.find("codec.name"), std::string::npos) << manifest.error().message;
            bake.probes->codec = prefix + file + "/moments/exact";
            EXPECT_FALSE(probes_from_json(to_json_text(*bake.probes, "probes.bin"), "probes.json"));
        }
}

TEST(Manifest, NoSceneIsReadByANameThatIsAFile) {
    const test::TestFolder folder("bake-scene-name");
    Manifest manifest = test::some_bake("sh1/moments/convolution").manifest;
    test::overwrite(folder.path() / "scene.glb", "anything");
    manifest.scene_name = (folder.path() / "scene.glb").string();
    const auto scene = read_baked_scene(folder.path(), manifest);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().message.find("holds no copy of its scene"), std::string::npos) << scene.error().message;
}

TEST(Manifest, TheDocumentStatesTheVersion) {
    const std::string document = test::contents(std::filesystem::path(LOBELIA_DOCS_DIR) / "bake-format.md");
    EXPECT_NE(document.find("\nVersion " + std::to_string(k_bake_version) + " "), std::string::npos);
    EXPECT_NE(document.find("| `lobelia_bake`, `program` | " + std::to_string(k_bake_version) + ";"),
              std::string::npos);
}

}  // namespace
}  // namespace lobelia
