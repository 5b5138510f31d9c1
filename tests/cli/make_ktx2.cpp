// Writes, for tests with independent readers, a texture of every pixel format, its expected values as plain float32
// (NAME.f32, channels side by side) and its bytes (NAME.bin), and a bake in every compatible storage. make_ktx2 FOLDER
#include <cstdio>

#include "bake_files.h"
#include "io/texture/ktx2.h"
#include "lobelia/storage.h"

namespace lobelia {
namespace {

void require(const Status& status) {
    if (status) return;
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    std::exit(1);
}

void write(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    auto file = StagedFile::create(path).value();
    require(file.write(bytes));
    require(file.commit());
}

constexpr std::size_t k_width = 21, k_height = 34;

/// Noise over many magnitudes, within the format's limits and beyond them.
std::vector<float> some_values(const FormatInfo& format, std::mt19937& generator) {
    std::vector<float> values(k_width * k_height);
    const double highest = std::min(format.highest, 1e6), lowest = std::max(format.lowest, -1e6);
    for (float& v : values) {
        const double share = static_cast<double>(generator()) / 4294967296.0;
        v = static_cast<float>(lowest < 0 && generator() % 2 ? lowest * share : highest * share);
        if (highest > 1) v = std::ldexp(v, -static_cast<int>(generator() % 24));
    }
    if (highest == 1) values[0] = 1.5f;
    if (lowest == 0) values[1] = -0.5f;
    return values;
}

void make_texture(const std::filesystem::path& folder, PixelFormat pixel_format) {
    const FormatInfo& format = info(pixel_format);
    std::mt19937 generator(7);
    std::vector<std::vector<float>> channels;
    std::vector<const float*> pointers;
    for (std::size_t k = 0; k < format.channels; ++k) channels.push_back(some_values(format, generator));
    for (const auto& channel : channels) pointers.push_back(channel.data());
    std::vector<float> side_by_side;
    for (std::size_t i = 0; i < k_width * k_height; ++i)
        for (const auto& channel : channels) side_by_side.push_back(channel[i]);

    std::vector<std::byte> data(byte_size(pixel_format, k_width, k_height));
    encode_texels(pixel_format, k_width, k_height, pointers, data);
    const std::string name(format.name);
    auto file = StagedFile::create(folder / (name + ".ktx2")).value();
    require(write_ktx2(file, {pixel_format, k_width, k_height, {data}, {{"lobelia.format", name}, {"a", "text"}}}));
    require(file.commit());
    write(folder / (name + ".bin"), data);
    write(folder / (name + ".f32"), std::as_bytes(std::span(side_by_side)));
}

/// A texture of 12 x 8 texels, or a cube map of 8 x 8, with four levels, as NAME.ktx2 under shapes/ and its levels'
/// bytes one after the other as NAME.bin.
void make_shape(const std::filesystem::path& folder, const std::string& name, TextureFile texture) {
    std::mt19937 generator(3);
    texture.format = PixelFormat::rgb9e5;
    texture.width = texture.faces == 6 ? 8 : 12;
    texture.height = 8;
    std::vector<std::vector<std::byte>> levels;
    for (std::size_t level = 0; level < 4; ++level) {
        levels.emplace_back(texture.images() * image_bytes(texture, level));
        for (std::byte& b : levels.back()) b = static_cast<std::byte>(generator() % 7);
    }
    texture.levels.assign(levels.begin(), levels.end());
    auto file = StagedFile::create(folder / (name + ".ktx2")).value();
    require(write_ktx2(file, texture));
    require(file.commit());
    std::vector<std::byte> all;
    for (const auto& level : levels) all.insert(all.end(), level.begin(), level.end());
    write(folder / (name + ".bin"), all);
}

/// Every compatible storage; values that bytes and half floats hold exactly where possible.
void make_bake(const std::filesystem::path& folder, const std::string& codec, TextureOptions textures = {}) {
    const Bake bake = textures.levels == 1 ? test::some_bake(codec) : test::some_bake(codec, Frame::world, 24, 40);
    const auto traits = coefficient_traits(*make_codec(codec)->encoder());
    WriteBakeOptions options;
    options.textures = std::move(textures);
    options.textures.storages.emplace();
    for (const Storage& storage : storages())
        if (suits(storage, traits)) options.textures.storages->emplace_back(storage.name);
    const auto written = write_bake(folder, bake, options);
    require(written ? Status(Done{}) : written.error());
}

}  // namespace
}  // namespace lobelia

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    for (const lobelia::PixelFormat format : lobelia::pixel_formats()) lobelia::make_texture(argv[1], format);
    const std::filesystem::path shapes = std::filesystem::path(argv[1]) / "shapes";
    std::filesystem::create_directory(shapes);
    for (const bool compressed : {false, true}) {
        const std::string end = compressed ? "-zstd" : "";
        const auto make = [&](const char* name, lobelia::TextureFile texture) {
            texture.compressed = compressed;
            lobelia::make_shape(shapes, name + end, texture);
        };
        make("levels", {});
        make("array", {.layers = 5});
        make("cube", {.faces = 6});
        make("volume", {.depth = 3});
    }
    lobelia::make_bake(std::filesystem::path(argv[1]) / "sh1", "sh1/moments/convolution");
    lobelia::make_bake(std::filesystem::path(argv[1]) / "sg12", "sg12/nnls/exact");
    lobelia::make_bake(std::filesystem::path(argv[1]) / "sh1-levels", "sh1/moments/convolution",
                       {.levels = 3, .zstd = lobelia::Switch::on});
    return 0;
}
