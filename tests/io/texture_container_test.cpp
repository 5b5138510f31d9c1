// Tests every texture container: it holds every pixel format, with its texels as they are, and refuses no size.
#include "io/texture/container.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "folders.h"

namespace lobelia {
namespace {

constexpr std::size_t k_width = 21, k_height = 34;

Status written(const TextureContainer& container, const std::filesystem::path& path, const TextureFile& texture) {
    auto file = StagedFile::create(path);
    if (!file) return file.error();
    if (auto status = write_texture(container, *file, texture); !status) return status;
    if (auto status = file->flush(); !status) return status;
    return file->commit();
}

/// Bytes that differ from their neighbours, so that no part of them is found by chance.
std::vector<std::byte> some_bytes(std::size_t count) {
    std::vector<std::byte> bytes(count);
    std::uint32_t state = 1;
    for (std::byte& b : bytes) b = static_cast<std::byte>((state = state * 1664525u + 1013904223u) >> 24);
    return bytes;
}

TEST(EveryTextureContainer, HoldsEveryPixelFormat) {
    const test::TestFolder folder("containers");
    for (const TextureContainer& container : texture_containers())
        for (const PixelFormat format : pixel_formats()) {
            SCOPED_TRACE(std::string(container.name) + " " + std::string(info(format).name));
            const auto data = some_bytes(byte_size(format, k_width, k_height));
            const auto path = folder.path() / "texture";
            const auto status = written(container, path, {format, k_width, k_height, {data}, {{"a", "text"}}});
            ASSERT_TRUE(status) << status.error().message;
            const std::string file = test::contents(path);
            const std::string texels(reinterpret_cast<const char*>(data.data()), data.size());
            EXPECT_GT(file.size(), texels.size());
            EXPECT_NE(file.find(texels), std::string::npos);
        }
}

/// A texture of a shape, of 11 x 7 texels, or 7 x 7 for cube maps, with as many levels as there can be.
struct Shape {
    const char* name;
    std::size_t layers, faces, depth;
};
constexpr std::array k_shapes = {Shape{"array", 5, 1, 0}, Shape{"cube", 0, 6, 0}, Shape{"cubes", 2, 6, 0},
                                 Shape{"volume", 0, 1, 3}};

/// Levels, layers and faces, each with bytes of its own.
struct ShapedTexture {
    ShapedTexture(PixelFormat format, const Shape& shape) {
        texture = {format, shape.faces == 6 ? 7u : 11u, 7, {}, {}, shape.layers, shape.faces, shape.depth};
        const std::size_t levels = shape.faces == 6 ? 3 : 4;
        for (std::size_t level = 0; level < levels; ++level)
            bytes.push_back(some_bytes(texture.images() * image_bytes(texture, level)));
        texture.levels.assign(bytes.begin(), bytes.end());
    }
    std::vector<std::vector<std::byte>> bytes;
    TextureFile texture;
};

TEST(EveryTextureContainer, HoldsEveryImageOfEveryLevel) {
    const test::TestFolder folder("container-shapes");
    for (const TextureContainer& container : texture_containers())
        for (const PixelFormat format : {PixelFormat::rgba16f, PixelFormat::rgb9e5, PixelFormat::bc6h_unsigned})
            for (const Shape& shape : k_shapes) {
                SCOPED_TRACE(std::string(container.name) + " " + shape.name);
                const ShapedTexture shaped(format, shape);
                const auto path = folder.path() / "texture";
                ASSERT_TRUE(written(container, path, shaped.texture));
                const std::string file = test::contents(path);
                for (std::size_t level = 0; level < shaped.bytes.size(); ++level) {
                    const std::size_t size = image_bytes(shaped.texture, level);
                    for (std::size_t image = 0; image < shaped.texture.images(); ++image)
                        EXPECT_NE(file.find(std::string_view(
                                      reinterpret_cast<const char*>(shaped.bytes[level].data()) + image * size, size)),
                                  std::string::npos)
                            << level << " " << image;
                }
            }
}

TEST(EveryTextureContainer, CompressesOrRefusesTo) {
    const test::TestFolder folder("container-zstd");
    const std::vector<std::byte> zeros(4096);
    for (const TextureContainer& container : texture_containers()) {
        TextureFile texture{PixelFormat::r8, 64, 64, {zeros}};
        texture.compressed = true;
        const auto status = written(container, folder.path() / "texture", texture);
        EXPECT_EQ(static_cast<bool>(status), container.compresses) << container.name;
        if (status)
            EXPECT_LT(test::contents(folder.path() / "texture").size(), 1000u);
        else
            EXPECT_NE(status.error().message.find(container.name), std::string::npos);
    }
}

TEST(EveryTextureContainer, TellsSizesAndFormatsApart) {
    const test::TestFolder folder("container-headers");
    const std::string zeros(64 * 16, '\0');
    const auto bytes = std::as_bytes(std::span(zeros));
    for (const TextureContainer& container : texture_containers()) {
        std::set<std::string> files;
        const std::vector<TextureFile> textures = {{PixelFormat::rgba32f, 8, 8, {bytes.first(1024)}},
                                                   {PixelFormat::rgba32f, 4, 16, {bytes.first(1024)}},
                                                   {PixelFormat::rgba32f, 16, 4, {bytes.first(1024)}},
                                                   {PixelFormat::rgba16f, 8, 16, {bytes.first(1024)}},
                                                   {PixelFormat::r32f, 16, 16, {bytes.first(1024)}}};
        for (const TextureFile& texture : textures) {
            ASSERT_TRUE(written(container, folder.path() / "texture", texture)) << container.name;
            files.insert(test::contents(folder.path() / "texture"));
        }
        EXPECT_EQ(files.size(), textures.size()) << container.name;
    }
}

TEST(EveryTextureContainer, RefusesImpossibleSizes) {
    const test::TestFolder folder("container-sizes");
    for (const TextureContainer& container : texture_containers())
        for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 0}, {65537, 1}, {1, 65537}})
            EXPECT_FALSE(written(container, folder.path() / "texture", {PixelFormat::r8, width, height, {}}));
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(EveryTextureContainer, IsFoundByItsName) {
    for (const TextureContainer& container : texture_containers())
        EXPECT_EQ(find_texture_container(container.name).value()->write, container.write);
    const auto unknown = find_texture_container("zip");
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().message.find("unknown texture container \"zip\"; available: ktx2"), 0u);
}

}  // namespace
}  // namespace lobelia
