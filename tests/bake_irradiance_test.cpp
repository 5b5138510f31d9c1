// A bake's irradiance is what its codec reads at each texel's normal; its textures hold what its pages do.
#include <gtest/gtest.h>

#include <cstring>

#include "bake_files.h"
#include "baker/bake/page_irradiance.h"
#include "baker/output/irradiance_files.h"
#include "folders.h"
#include "io/read_exr_channels.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;
using test::some_bake;

std::vector<Rgb> coefficients_at(const Page& page, std::size_t coefficients, std::size_t texel) {
    std::vector<Rgb> c;
    for (std::size_t i = 0; i < coefficients; ++i)
        c.push_back({page.planes[3 * i][texel], page.planes[3 * i + 1][texel], page.planes[3 * i + 2][texel]});
    return c;
}

/// An evaluator that is not linear: the square of another.
class Squared final : public Evaluator {
  public:
    explicit Squared(std::shared_ptr<const Evaluator> inner) : inner_(std::move(inner)) {}
    [[nodiscard]] std::string name() const override { return "squared"; }
    [[nodiscard]] Accuracy accuracy() const override { return {}; }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        inner_->signed_irradiance(c, normals, out);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < out.size; ++i) out.channel(k)[i] *= out.channel(k)[i];
    }

  private:
    std::shared_ptr<const Evaluator> inner_;
};

void expect_read_texel_by_texel(const Bake& bake, const Evaluator& evaluator) {
    const Page& page = bake.pages[0];
    const Frame frame = bake.manifest.options.frame;
    const auto read = page_irradiance(page, bake.layout(), bake.normals[0], frame, evaluator);
    ASSERT_EQ(read.size(), page.size());
    for (std::size_t i = 0; i < page.size(); ++i) {
        const Vec3 n = bake.normals[0][i];
        if (n == Vec3{}) {
            EXPECT_EQ(read[i], Rgb{});
            continue;
        }
        Directions normal(1);
        Colours expected(1);
        set_entry(normal.view(), 0, frame == Frame::world ? n : Vec3{0, 0, 1});
        irradiance(evaluator, coefficients_at(page, bake.manifest.coefficients, i), normal, expected);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR((&read[i].r)[k], expected.channel(k)[0], 2e-5f * (1 + std::abs(expected.channel(k)[0])));
    }
}

TEST(PageIrradiance, EqualsTheEvaluatorTexelByTexel) {
    for (const Frame frame : {Frame::world, Frame::tangent})
        for (const char* name : {"sh1/moments/convolution", "sh2/moments/convolution-signed", "sg12/moments/hill"}) {
            SCOPED_TRACE(name);
            const auto codec = make_codec(name).value();
            expect_read_texel_by_texel(some_bake(name, frame), codec.evaluator());
            expect_read_texel_by_texel(some_bake(name, frame),
                                       Squared(codec.basis().evaluator(codec.name().evaluator)));
        }
}

TEST(IrradianceFiles, HoldWhatIsReadAndTheValidity) {
    const test::TestFolder folder("irradiance-files");
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(folder.path() / "bake", bake));
    const auto read = read_bake(folder.path() / "bake");
    ASSERT_TRUE(read);
    const auto files = write_irradiance(folder.path() / "e", *read, {"convolution-signed"});
    ASSERT_TRUE(files) << files.error().message;
    ASSERT_EQ(*files, (std::vector<fs::path>{folder.path() / "e" / "page-0.exr", folder.path() / "e" / "page-1.exr"}));
    const auto evaluator = make_basis("sh1").value()->evaluator("convolution-signed");
    for (std::size_t p = 0; p < 2; ++p) {
        const auto file = read_exr_channels((*files)[p], {.wanted = {"R", "G", "B", "validity"}});
        ASSERT_TRUE(file) << file.error().message;
        const auto expected = page_irradiance(bake.pages[p], bake.layout(), bake.normals[p], Frame::world, *evaluator);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ((Rgb{file->planes[0][i], file->planes[1][i], file->planes[2][i]}), expected[i]);
            EXPECT_EQ(file->planes[3][i], i % 5 == 0 ? 0 : bake.pages[p].validity[i]);
        }
    }
    const auto unknown = write_irradiance(folder.path() / "none", *read, {"convolutoin"});
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("did you mean convolution"), std::string::npos) << unknown.error().message;
    EXPECT_FALSE(fs::exists(folder.path() / "none"));
}

std::uint64_t number_at(const std::string& bytes, std::size_t place, std::size_t size) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + place, size);
    return value;
}

TEST(BakeTextures, AreNamedInTheManifestAndHoldThePage) {
    const test::TestFolder folder("bake-textures");
    Bake bake = some_bake("sh1/moments/convolution");
    // Numbers that halves hold.
    for (auto& plane : bake.pages[1].planes)
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = static_cast<float>(i % 512) / 8 - 9;
    ASSERT_TRUE(write_bake(folder.path(), bake));
    const auto manifest = read_manifest(folder.path());
    ASSERT_TRUE(manifest) << manifest.error().message;
    const auto& textures = manifest->pages[1].textures;
    ASSERT_EQ(textures.size(), 3u);
    EXPECT_EQ(textures[0].file, "page-1.half.c.ktx2");
    EXPECT_EQ(textures[1].packing, "l1-over-l0");
    EXPECT_EQ(textures[1].file, "page-1.l1-over-l0.l0.ktx2");
    EXPECT_EQ(textures[2].format, "unorm8");
    EXPECT_EQ(textures[2].layers.size(), 3u);

    // Khronos 2021, section 3: identifier, format, size of type, width, height, depth, layers, faces, levels, scheme;
    // the level's place at 80. Half 1.0 is 0x3c00, its exponent at 10.
    const std::string bytes = test::contents(folder.path() / textures[0].file);
    EXPECT_EQ(bytes.substr(0, 12), std::string("\xabKTX 20\xbb\r\n\x1a\n"));
    const std::array<std::uint64_t, 9> header{97, 2, 21, 34, 0, 4, 1, 1, 0};
    for (std::size_t i = 0; i < header.size(); ++i) EXPECT_EQ(number_at(bytes, 12 + 4 * i, 4), header[i]) << i;
    const std::uint64_t texels = number_at(bytes, 80, 8), length = number_at(bytes, 88, 8);
    EXPECT_EQ(length, 21u * 34 * 4 * 8);
    EXPECT_EQ(texels + length, bytes.size());
    const auto half_at = [&](std::size_t layer, std::size_t texel, std::size_t k) {
        const auto bits = static_cast<int>(number_at(bytes, texels + 8 * (layer * 714 + texel) + 2 * k, 2));
        const int exponent = bits >> 10 & 31, fraction = bits & 1023;
        const float value = exponent ? std::ldexp(1024.0f + static_cast<float>(fraction), exponent - 25)
                                     : std::ldexp(static_cast<float>(fraction), -24);
        return bits & 0x8000 ? -value : value;
    };
    for (std::size_t layer = 0; layer < 4; ++layer)
        for (std::size_t i = 0; i < 714; ++i) {
            for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(half_at(layer, i, k), bake.pages[1].planes[3 * layer + k][i]);
            EXPECT_NEAR(half_at(layer, i, 3), bake.pages[1].validity[i], 1.0f / 4096);
        }
}

TEST(BakeTextures, OnlyThoseAskedFor) {
    const test::TestFolder folder("bake-textures-chosen");
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(folder.path(), bake, {.packings = std::vector<std::string>{}}));
    EXPECT_EQ(folder.entries(), 5u);  // the manifest, two pages, the probes' two files
    const auto unknown = write_bake(folder.path() / "none", bake, {.packings = {{"l1-over-l1"}}});
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("did you mean l1-over-l0"), std::string::npos) << unknown.error().message;
    EXPECT_EQ(folder.entries(), 5u);
}

TEST(BakeFolder, FullDiskChangesNothing) {
    const test::TestFolder folder("bake-full");
    Bake bake = some_bake("sh1/moments/convolution");
    const auto write = [&](const fs::path& path, rlim_t most) {
        const test::FileSizeLimit limit(most);
        return write_bake(path, bake);
    };
    // Files of less than 100 bytes, of less than an EXR page, of less than a texture, and as many as there are.
    for (const rlim_t most : {100u, 4000u, 20000u}) {
        const auto status = write(folder.path() / "new", most);
        ASSERT_FALSE(status) << most;
        EXPECT_NE(status.error().message.find("new/page-0"), std::string::npos) << status.error().message;
        EXPECT_EQ(folder.entries(), 0u);
    }
    ASSERT_TRUE(write_bake(folder.path() / "new", bake));
    const std::string manifest = test::contents(folder.path() / "new" / k_manifest_name);
    const auto files = std::distance(fs::directory_iterator(folder.path() / "new"), fs::directory_iterator());
    bake.manifest.scene_name = "another";
    ASSERT_FALSE(write(folder.path() / "new", 4000));
    EXPECT_EQ(test::contents(folder.path() / "new" / k_manifest_name), manifest);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "new"), fs::directory_iterator()), files);
}

TEST(BakeFolder, MorePagesThanFilesMayBeOpen) {
    const test::TestFolder folder("bake-many");
    Bake bake = some_bake("sh1/moments/convolution");
    for (int i = 0; i < 45; ++i) {
        bake.pages.push_back(bake.pages[1]);
        bake.normals.push_back(bake.normals[1]);
    }
    rlimit old{};
    ::getrlimit(RLIMIT_NOFILE, &old);
    const rlimit few{80, old.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
    const auto status = write_bake(folder.path(), bake, {.packings = {{"half"}}});
    ::setrlimit(RLIMIT_NOFILE, &old);
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(folder.entries(), 2u * 47 + 3);
    EXPECT_TRUE(read_bake(folder.path()));
    // And where the last one does not fit, nothing is left, temporary names included.
    bake.pages.back().chart[0] = (1u << 24) + 1;
    EXPECT_FALSE(write_bake(folder.path() / "again", bake, {.packings = std::vector<std::string>{}}));
    EXPECT_FALSE(fs::exists(folder.path() / "again"));
}

TEST(BakeFolder, AFileInItsPlaceIsAnError) {
    const test::TestFolder folder("bake-file");
    test::overwrite(folder.path() / "file", "text");
    const auto status = write_bake(folder.path() / "file", some_bake("sh1/moments/convolution"));
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("file: cannot be made a folder"), std::string::npos);
    EXPECT_EQ(test::contents(folder.path() / "file"), "text");
}

}  // namespace
}  // namespace lobelia
