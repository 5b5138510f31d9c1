// 8- and 16-bit pictures as textures, and decoded from sRGB to linear as environments.
#include "io/read_picture.h"

#include <fmt/format.h>

#include <limits>

#include "core/math/colour.h"
#include "io/decode_picture.h"
#include "io/image_checks.h"

namespace lobelia {

namespace {

template <class Texel>
std::vector<Rgb> linear(const std::vector<Texel>& texels) {
    // Tabulate the curve: there are at most 65536 different samples.
    constexpr std::size_t k_levels = std::size_t{std::numeric_limits<typename Texel::value_type>::max()} + 1;
    std::vector<float> curve(k_levels);
    for (std::size_t i = 0; i < k_levels; ++i)
        curve[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / (k_levels - 1)));

    std::vector<Rgb> pixels(texels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = {curve[texels[i][0]], curve[texels[i][1]], curve[texels[i][2]]};
    return pixels;
}

}  // namespace

Result<PictureRgba8> read_picture_rgba8(std::span<const std::byte> bytes, std::string_view name,
                                        std::size_t most_pixels) {
    auto picture = io::decode_picture(bytes, name, {.most_pixels = most_pixels});
    if (!picture) return picture.error();
    return PictureRgba8{picture->width, picture->height, std::get<std::vector<io::Rgba8>>(std::move(picture->texels))};
}

Result<LoadedImage> read_ldr(std::span<const std::byte> bytes, std::string_view name, const ReadOptions& options) {
    if (!options.ldr)
        return Error{
            fmt::format("{}: a low dynamic range picture, in which suns and lamps are clipped at white; pass --ldr to "
                        "use it anyway",
                        name)};
    const auto picture = io::decode_picture(
        bytes, name, {.most_pixels = options.most_pixels, .depth = io::PictureOptions::Depth::stored});
    if (!picture) return picture.error();
    LoadedImage loaded;
    loaded.image.width = picture->width;
    loaded.image.height = picture->height;
    loaded.image.pixels = std::visit([](const auto& texels) { return linear(texels); }, picture->texels);
    return io::inspected(std::move(loaded), name, options);
}

}  // namespace lobelia
