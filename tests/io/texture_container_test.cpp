// Tests every texture container: it holds every pixel format, with its texels as they are, and refuses no size.
#include "io/texture/container.h"

#include <gtest/gtest.h>

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
            const auto status = written(container, path, {format, k_width, k_height, data, {{"a", "text"}}});
            ASSERT_TRUE(status) << status.error().message;
            const std::string file = test::contents(path);
            const std::string texels(reinterpret_cast<const char*>(data.data()), data.size());
            EXPECT_GT(file.size(), texels.size());
            EXPECT_NE(file.find(texels), std::string::npos);
        }
}

TEST(EveryTextureContainer, TellsSizesAndFormatsApart) {
    const test::TestFolder folder("container-headers");
    const std::string zeros(64 * 16, '\0');
    const auto bytes = std::as_bytes(std::span(zeros));
    for (const TextureContainer& container : texture_containers()) {
        std::set<std::string> files;
        const std::vector<TextureFile> textures = {{PixelFormat::rgba32f, 8, 8, bytes.first(1024), {}},
                                                   {PixelFormat::rgba32f, 4, 16, bytes.first(1024), {}},
                                                   {PixelFormat::rgba32f, 16, 4, bytes.first(1024), {}},
                                                   {PixelFormat::rgba16f, 8, 16, bytes.first(1024), {}},
                                                   {PixelFormat::r32f, 16, 16, bytes.first(1024), {}}};
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
            EXPECT_FALSE(written(container, folder.path() / "texture", {PixelFormat::r8, width, height, {}, {}}));
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
