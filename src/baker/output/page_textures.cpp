// Lightmap pages as textures for GPUs.
#include "baker/output/page_textures.h"

#include <fmt/format.h>

#include <cassert>

#include "io/write_ktx2.h"

namespace lobelia {

const char* format_name(TexelFormat format) { return format == TexelFormat::half ? "half" : "unorm8"; }

Status write_page_texture(StagedFile& file, const Page& page, const TexturePacking& packing, std::size_t array,
                          const std::string& origin) {
    // Find the array's layers among those of all textures.
    const auto textures = packing.textures();
    assert(array < textures.size());
    std::size_t first = 0, all = 0;
    for (std::size_t i = 0; i < textures.size(); ++i) {
        if (i < array) first += textures[i].layers.size();
        all += textures[i].layers.size();
    }
    const TextureArray& target = textures[array];
    const std::size_t layers = target.layers.size();

    // Pack texel by texel.
    const Ktx2Texture texture{target.format,
                              page.width,
                              page.height,
                              layers,
                              {{"lobelia.packing", packing.name()},
                               {"lobelia.layers", fmt::format("{}", fmt::join(target.layers, "\n"))},
                               {"lobelia.reading", packing.reading()},
                               {"lobelia.origin", origin}}};
    std::vector<Rgb> c(packing.coefficients()), packed(all);
    return write_ktx2(file, texture, [&](std::size_t y, std::span<Rgba> texels) {
        for (std::size_t x = 0; x < page.width; ++x) {
            const std::size_t i = y * page.width + x;
            for (std::size_t k = 0; k < c.size(); ++k)
                c[k] = {page.planes[3 * k][i], page.planes[3 * k + 1][i], page.planes[3 * k + 2][i]};
            packing.pack(c, packed);
            for (std::size_t layer = 0; layer < layers; ++layer) {
                const Rgb colour = packed[first + layer];
                texels[layer * page.width + x] = {colour.r, colour.g, colour.b, page.validity[i]};
            }
        }
    });
}

}  // namespace lobelia
