// Tests of what a bake's folder holds for other programs: plain lightmaps and shader code.
#include <gtest/gtest.h>

#include "bake/write/lightmap_exports.h"
#include "bake_files.h"
#include "folders.h"
#include "io/read_exr_channels.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

Result<Manifest> written(const fs::path& folder, const Bake& bake, const Names& exports, const Names& storages = {}) {
    WriteBakeOptions options;
    options.exports = exports;
    options.textures.storages = storages;
    return write_bake(folder, bake, options);
}

TEST(LightmapExports, HoldTheIrradianceOfThePage) {
    const test::TestFolder folder("lightmap-exports");
    Bake bake = test::some_bake("sh1/moments/convolution");
    bake.manifest.precision = Precision::full;
    Names names;
    for (const LightmapExport& entry : lightmap_exports()) names.emplace_back(entry.name);
    ASSERT_TRUE(written(folder.path(), bake, names));
    for (const LightmapExport& entry : lightmap_exports()) {
        if (entry.place == LightmapExport::Place::scene) continue;  // SceneCopy.PlainLightmapsForOtherViewers
        const std::string stem = "page-1." + std::string(entry.name);
        EXPECT_TRUE(fs::exists(folder.path() / (stem + ".ktx2")));
        const auto planes = read_exr_channels(folder.path() / (stem + ".exr"));
        ASSERT_TRUE(planes) << planes.error().message;
        EXPECT_EQ(planes->names, (Names{"B", "G", "R"}));
        const LightmapPage& page = bake.pages[1];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < page.size(); ++i) {
                const double e = std::max(0.0f, page.planes[bake.channels().irradiance(k)][i]);
                EXPECT_FLOAT_EQ(planes->planes[2 - k][i], static_cast<float>(entry.factor * e));
            }
    }
    // A later bake without them takes them away.
    ASSERT_TRUE(written(folder.path(), bake, {}));
    EXPECT_FALSE(fs::exists(folder.path() / "page-1.rgb.exr"));
    EXPECT_TRUE(fs::exists(folder.path() / "page-1.exr"));
}

TEST(LightmapExports, UnknownNamesAreRefusedBeforeAnythingIsWritten) {
    const test::TestFolder folder("lightmap-exports-unknown");
    const auto manifest = written(folder.path() / "bake", test::some_bake("sh1/moments/convolution"), {"tiff"});
    ASSERT_FALSE(manifest);
    EXPECT_EQ(manifest.error().message, "unknown export \"tiff\"; available: rgb, rgb-over-pi, moz-lightmap");
    EXPECT_FALSE(fs::exists(folder.path() / "bake" / "bake.json"));
}

TEST(ShaderFiles, StandBesideTheTexturesOfTheirStorage) {
    const test::TestFolder folder("shader-files");
    const Bake bake = test::some_bake("sh1/moments/geomerics", Frame::tangent);
    const auto manifest = written(folder.path(), bake, {}, {"float16", "ratio8"});
    ASSERT_TRUE(manifest) << manifest.error().message;
    for (const std::string& storage : std::vector<std::string>{"float16", "ratio8"})
        for (const std::string& extension : std::vector<std::string>{"glsl", "hlsl", "wgsl", "metal"}) {
            const std::string name = "decode." + storage + "." + extension;
            const std::string text = test::contents(folder.path() / name);
            for (const char* function : {"to_tangent(", "unpack(", "irradiance(", "specular("})
                EXPECT_NE(text.find(function), std::string::npos) << name << " " << function;
            EXPECT_TRUE(std::any_of(manifest->files.begin(), manifest->files.end(), [&](const FileEntry& entry) {
                return entry.file == name;
            })) << name;
        }
    EXPECT_TRUE(fs::exists(folder.path() / "ggx-lobe.ktx2"));
    // A codec without shader code says so, and what was there goes.
    const auto without = written(folder.path(), test::some_bake("sh1/moments/dering"), {}, {"float16"});
    ASSERT_TRUE(without) << without.error().message;
    ASSERT_FALSE(without->warnings.empty());
    EXPECT_NE(without->warnings.back().find("no shader code is written: evaluator dering"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder.path() / "decode.float16.glsl"));
    EXPECT_FALSE(fs::exists(folder.path() / "ggx-lobe.ktx2"));
}

}  // namespace
}  // namespace lobelia
