// Tests that a bake's irradiance equals the codec's at each texel's normal, and that its textures hold the values of
// its pages.
#include <gtest/gtest.h>

#include <cstring>

#include "bake/solve/page_irradiance.h"
#include "bake/write/irradiance_files.h"
#include "bake/write/manifest.h"
#include "bake_files.h"
#include "folders.h"
#include "io/read_exr_channels.h"
#include "io/texture/container.h"
#include "lobelia/storage.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;
using test::some_bake;

std::vector<Rgb> coefficients_at(const LightmapPage& page, std::size_t coefficients, std::size_t texel) {
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
    const LightmapPage& page = bake.pages[0];
    const Frame frame = bake.manifest.options.frame;
    const auto read = page_irradiance(page, bake.channels(), bake.normals[0], frame, evaluator);
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
        const auto expected =
            page_irradiance(bake.pages[p], bake.channels(), bake.normals[p], Frame::world, *evaluator);
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

/// Parses one layer of the largest level of a KTX 2.0 file. Khronos 2021, section 3: identifier, format, size of type,
/// width, height, depth, layers, faces, levels, scheme; the largest level's offset and its length at byte 80.
PackedTexture texture_in(const fs::path& file, PixelFormat format, std::optional<std::size_t> layer = {}) {
    const std::string bytes = test::contents(file);
    EXPECT_EQ(bytes.substr(0, 12), std::string("\xabKTX 20\xbb\r\n\x1a\n"));
    EXPECT_EQ(number_at(bytes, 12, 4), info(format).vk_format);
    const std::uint64_t layers = number_at(bytes, 32, 4);
    EXPECT_EQ(layers > 0, layer.has_value());
    EXPECT_EQ(number_at(bytes, 28, 4), 0u);
    EXPECT_EQ(number_at(bytes, 36, 4), 1u);
    EXPECT_EQ(number_at(bytes, 44, 4), 0u);
    PackedTexture texture{"", format, number_at(bytes, 20, 4), number_at(bytes, 24, 4), 1, {}};
    const std::uint64_t begin = number_at(bytes, 80, 8), length = number_at(bytes, 88, 8);
    EXPECT_EQ(begin + length, bytes.size());
    const std::size_t size = byte_size(format, texture.width, texture.height);
    EXPECT_EQ(length, size * std::max<std::uint64_t>(layers, 1));
    const auto data = std::as_bytes(std::span(bytes)).subspan(begin + layer.value_or(0) * size, size);
    texture.data.assign(data.begin(), data.end());
    return texture;
}

CoefficientTraits traits_of(const std::string& codec) { return coefficient_traits(*make_codec(codec)->encoder()); }

/// A bake whose coefficients have the traits of the codec's.
Bake some_bake_within(const std::string& codec) {
    Bake bake = some_bake(codec);
    const CoefficientTraits traits = traits_of(codec);
    for (LightmapPage& page : bake.pages)
        for (std::size_t p = 0; p < 3 * traits.count; ++p)
            for (std::size_t i = 0; i < page.size(); ++i) {
                float& v = page.planes[p][i];
                const bool bounded = !traits.lead_bounds.empty();
                if (traits.non_negative || (bounded && p < 3)) v = std::abs(v);
                if (bounded && p >= 3) v *= traits.lead_bounds[p / 3] * page.planes[p % 3][i] / 3;
            }
    return bake;
}

/// Reads the files of one storage back, as the manifest says.
LightmapPage page_in(const fs::path& folder, const PageEntry& baked, const Storage& storage, const LightmapPage& like,
                     std::size_t coefficients) {
    TextureLayout layout{coefficients, {}};
    std::vector<PackedTexture> packed;
    for (const TextureEntry& texture : baked.textures) {
        if (texture.storage != storage.name) continue;
        const std::string part(texture.layer ? info(texture.layout.format).name : texture.layout.name);
        const bool half = texture.layer && texture.layout.subsampling > 1;
        EXPECT_EQ(texture.file, "page-0." + texture.storage + "." + part + (half ? "-half" : "") + ".ktx2");
        layout.textures.push_back(texture.layout);
        packed.push_back(texture_in(folder / texture.file, texture.layout.format, texture.layer));
        packed.back().scale = texture.scale;
    }
    EXPECT_FALSE(packed.empty());
    LightmapPage back = like;
    unpack(layout, packed, {back.width, back.height, std::span(back.planes), coefficients});
    return back;
}

TEST(BakeTextures, FilesHoldThePageWithinEachStoragesBound) {
    for (const char* codec : {"sh1/moments/convolution", "sg3/nnls/exact", "ahd/moments/punctual"}) {
        Bake bake = some_bake_within(codec);
        bake.pages.pop_back();
        bake.normals.pop_back();
        bake.manifest.objects.pop_back();  // its texels are on that page
        const CoefficientTraits traits = traits_of(codec);
        WriteBakeOptions options;
        options.textures.storages.emplace();
        for (const Storage& storage : storages())
            if (suits(storage, traits)) options.textures.storages->emplace_back(storage.name);
        const test::TestFolder folder("bake-textures");
        ASSERT_TRUE(write_bake(folder.path(), bake, options));
        const auto manifest = read_manifest(folder.path());
        ASSERT_TRUE(manifest) << manifest.error().message;
        const LightmapPage& page = bake.pages[0];
        for (const std::string& name : *options.textures.storages) {
            SCOPED_TRACE(std::string(codec) + " " + name);
            const Storage& storage = *find_storage(name).value();
            const LightmapPage back = page_in(folder.path(), manifest->pages[0], storage, page, traits.count);
            LightmapPage allowed = page;
            allowed_error(storage, traits, {page.width, page.height, std::span(page.planes), traits.count},
                          {page.width, page.height, std::span(allowed.planes), traits.count});
            for (std::size_t p = 0; p < 3 * traits.count; ++p)
                for (std::size_t i = 0; i < page.size(); ++i) {
                    const float value = page.planes[p][i];
                    EXPECT_LE(std::abs(back.planes[p][i] - value), allowed.planes[p][i] + 1e-6f * std::abs(value));
                }
        }
    }
}

TEST(BakeTextures, HalvesRatiosAndValidityWhereNothingIsAskedFor) {
    const test::TestFolder folder("bake-textures");
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(folder.path(), bake));
    const auto manifest = read_manifest(folder.path());
    ASSERT_TRUE(manifest) << manifest.error().message;
    std::vector<std::string> files;
    for (const TextureEntry& texture : manifest->pages[1].textures)
        files.push_back(texture.file + (texture.layer ? " " + std::to_string(*texture.layer) : ""));
    EXPECT_EQ(files, (std::vector<std::string>{"page-1.float16.rgba16f.ktx2 0", "page-1.float16.rgba16f.ktx2 1",
                                               "page-1.float16.rgba16f.ktx2 2", "page-1.ratio8.c0.ktx2",
                                               "page-1.ratio8.rgba8.ktx2 0", "page-1.ratio8.rgba8.ktx2 1",
                                               "page-1.ratio8.ratio2.ktx2"}));
    ASSERT_EQ(manifest->pages[1].validity, "page-1.validity.ktx2");
    const PackedTexture validity = texture_in(folder.path() / "page-1.validity.ktx2", PixelFormat::r8);
    for (std::size_t i = 0; i < bake.pages[1].size(); ++i)
        EXPECT_NEAR(static_cast<float>(validity.data[i]) / 255, bake.pages[1].validity[i], 0.501f / 255);
}

TEST(BakeTextures, EveryContainerIsTheExtensionOfItsFiles) {
    const Bake bake = some_bake("sh1/moments/convolution");
    for (const TextureContainer& container : texture_containers()) {
        const test::TestFolder folder("bake-containers");
        const std::string name(container.name);
        ASSERT_TRUE(write_bake(folder.path(), bake, {.textures = {.storages = {{"float16"}}, .container = name}}));
        const auto manifest = read_manifest(folder.path());
        ASSERT_TRUE(manifest) << manifest.error().message;
        EXPECT_EQ(manifest->pages[0].validity, "page-0.validity." + name);
        EXPECT_EQ(manifest->pages[0].textures[0].file, "page-0.float16.rgba16f." + name);
        EXPECT_TRUE(fs::exists(folder.path() / manifest->pages[0].textures[0].file));
    }
    const test::TestFolder folder("bake-containers");
    const auto refused = write_bake(folder.path() / "none", bake, {.textures = {.container = "zip"}});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, find_texture_container("zip").error().message);
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(BakeTextures, AFileForEachWithoutArrays) {
    const test::TestFolder folder("bake-loose-textures");
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(folder.path(), bake, {.textures = {.storages = {{"float16"}}, .arrays = Switch::off}}));
    const auto manifest = read_manifest(folder.path());
    ASSERT_TRUE(manifest) << manifest.error().message;
    std::size_t i = 0;
    for (const TextureEntry& texture : manifest->pages[0].textures) {
        EXPECT_EQ(texture.file, "page-0.float16.v" + std::to_string(i++) + ".ktx2");
        EXPECT_FALSE(texture.layer);
        EXPECT_EQ(texture_in(folder.path() / texture.file, texture.layout.format).width, bake.manifest.width);
    }
    EXPECT_EQ(i, 3u);
}

TEST(BakeTextures, MipLevelsThatAPageCannotHaveAreRefused) {
    const test::TestFolder folder("bake-levels");
    const auto message = [&](const std::string& storage, std::uint32_t levels, std::size_t width) {
        const auto status =
            write_bake(folder.path() / "none", some_bake("sh1/moments/convolution", Frame::world, width, 40),
                       {.textures = {.storages = {{storage}}, .levels = levels}});
        return status ? "" : status.error().message;
    };
    EXPECT_EQ(message("float16", 4, 24), "");
    EXPECT_EQ(message("float16", 5, 24), "5 mip levels: the sides of a page of 24 x 40 texels are not multiples of 16");
    EXPECT_EQ(message("float16", 2, 25), "2 mip levels: the sides of a page of 25 x 40 texels are not multiples of 2");
    EXPECT_EQ(message("float16", 1, 25), "");
    EXPECT_EQ(message("ycocg", 4, 24), "4 mip levels: the sides of a page of 24 x 40 texels are not multiples of 16");
    const auto zstd = write_bake(folder.path() / "none", some_bake("sh1/moments/convolution"),
                                 {.textures = {.container = "dds", .zstd = Switch::on}});
    ASSERT_FALSE(zstd);
    EXPECT_EQ(zstd.error().message, "zstd: the texture container \"dds\" has no compression");
}

TEST(BakeTextures, OnlyThoseAskedFor) {
    const test::TestFolder folder("bake-textures-chosen");
    const Bake bake = some_bake("sh1/moments/convolution");
    ASSERT_TRUE(write_bake(folder.path(), bake, {.textures = {.storages = std::vector<std::string>{}}}));
    EXPECT_EQ(folder.entries(), 5u);  // the manifest, two pages, the probes' two files
    const auto message = [&](const std::string& codec, const char* storage) {
        const auto status =
            write_bake(folder.path() / "none", some_bake(codec), {.textures = {.storages = {{storage}}}});
        return status ? "" : status.error().message;
    };
    EXPECT_NE(message("sh1/moments/convolution", "ratoi8").find("did you mean ratio8"), std::string::npos);
    EXPECT_EQ(message("sh1/moments/convolution", "rgb9e5"),
              "sh1/moments/convolution: storage \"rgb9e5\" requires non-negative coefficients; usable with this codec: "
              "float32, float16, ycocg, bc6h-signed, ratio8, ratio10, bc6h-ratio8");
    EXPECT_NE(message("sg12/moments/exact", "ratio8").find("that the first of them bounds"), std::string::npos);
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
    for (int i = 0; i < 20; ++i) {
        bake.pages.push_back(bake.pages[1]);
        bake.normals.push_back(bake.normals[1]);
    }
    rlimit old{};
    ::getrlimit(RLIMIT_NOFILE, &old);
    const rlimit few{80, old.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
    const auto status =
        write_bake(folder.path(), bake, {.textures = {.storages = {{"bc6h-signed"}}, .arrays = Switch::off}});
    ::setrlimit(RLIMIT_NOFILE, &old);
    ASSERT_TRUE(status) << status.error().message;
    // Of each page its file, four textures and validity; bake.json, two files of probes and a texture of their
    // validity, four of shader code.
    EXPECT_EQ(folder.entries(), (1u + 4 + 1) * 22 + 4 + 5);  // more than may be open
    EXPECT_TRUE(read_bake(folder.path()));
    // If the last file does not fit, nothing is left behind, including temporary files.
    bake.pages.back().chart[0] = (1u << 24) + 1;
    EXPECT_FALSE(write_bake(folder.path() / "again", bake, {.textures = {.storages = std::vector<std::string>{}}}));
    EXPECT_FALSE(fs::exists(folder.path() / "again"));
}

TEST(BakeFolder, AFileInItsPlaceIsAnError) {
    const test::TestFolder folder("bake-file");
    test::overwrite(folder.path() / "file", "text");
    const auto status = write_bake(folder.path() / "file", some_bake("sh1/moments/convolution"));
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("file: cannot create the folder"), std::string::npos);
    EXPECT_EQ(test::contents(folder.path() / "file"), "text");
}

}  // namespace
}  // namespace lobelia
