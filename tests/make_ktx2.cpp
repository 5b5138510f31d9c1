// Writes textures of random pages, and beside each the numbers that it should hold as plain float32, for readers that
// are not ours. make_ktx2 FOLDER
#include <cstdio>

#include "bake_files.h"
#include "baker/output/page_textures.h"

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

/// Layer after layer, row after row, red, green, blue, alpha.
std::vector<float> expected(const Page& page, const TexturePacking& packing) {
    std::size_t layers = 0;
    for (const auto& array : packing.textures()) layers += array.layers.size();
    std::vector<float> values(4 * page.size() * layers);
    std::vector<Rgb> c(packing.coefficients()), packed(layers);
    for (std::size_t i = 0; i < page.size(); ++i) {
        for (std::size_t k = 0; k < c.size(); ++k)
            c[k] = {page.planes[3 * k][i], page.planes[3 * k + 1][i], page.planes[3 * k + 2][i]};
        packing.pack(c, packed);
        for (std::size_t layer = 0; layer < layers; ++layer) {
            float* texel = values.data() + 4 * (layer * page.size() + i);
            texel[0] = packed[layer].r;
            texel[1] = packed[layer].g;
            texel[2] = packed[layer].b;
            texel[3] = page.validity[i];
        }
    }
    return values;
}

void make(const std::filesystem::path& folder, const std::string& codec) {
    Bake bake = test::some_bake(codec);
    Page& page = bake.pages[0];
    // What halves do with large, small and very small numbers.
    for (std::size_t i = 1; i < 5; ++i) page.planes[0][i] = std::pow(10.0f, static_cast<float>(2 * i) - 9);
    page.planes[1][6] = 1e6f;
    const auto basis = make_codec(codec)->basis().packings();
    for (const auto& packing : basis) {
        const std::vector<float> values = expected(page, *packing);
        std::size_t layer = 0;
        for (std::size_t i = 0; i < packing->textures().size(); ++i) {
            const auto array = packing->textures()[i];
            const std::string stem = parse_codec_name(codec)->basis + "-" + packing->name() + "-" + array.name;
            auto file = StagedFile::create(folder / (stem + ".ktx2")).value();
            require(write_page_texture(file, page, *packing, i, codec));
            require(file.commit());
            const std::size_t size = 4 * page.size();
            write(folder / (stem + ".f32"),
                  std::as_bytes(std::span(values).subspan(layer * size, array.layers.size() * size)));
            layer += array.layers.size();
        }
    }
}

}  // namespace
}  // namespace lobelia

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    for (const char* codec : {"sh1/moments/convolution", "sh2/moments/convolution", "sg12/moments/exact"})
        lobelia::make(argv[1], codec);
    return 0;
}
