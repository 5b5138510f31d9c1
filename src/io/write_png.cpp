// PNG pictures by stb_image_write, made in memory and written atomically.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include <fmt/format.h>

#include "core/math/colour.h"
#include "io/image_checks.h"
#include "io/write_file.h"
#include "io/write_image.h"

namespace lobelia {

namespace {

std::uint8_t encoded(float linear, ToneCurve tone) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(toned(tone, static_cast<double>(linear)))));
}

void append(void* target, void* data, int size) {
    static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

struct PngSource {
    std::size_t width, height;
    int channels;
    std::span<const std::uint8_t> bytes;
};

Result<std::string> encode(const PngSource& source) {
    // stb_image_write counts bytes in int.
    constexpr std::size_t k_most_pixels = std::size_t{1} << 28;
    const std::size_t pixels = source.width * source.height;
    if (pixels == 0 || source.width > io::k_most_side || source.height > io::k_most_side || pixels > k_most_pixels ||
        source.bytes.size() != static_cast<std::size_t>(source.channels) * pixels)
        return Error{fmt::format("a picture of {} x {} pixels in {} bytes cannot be written", source.width,
                                 source.height, source.bytes.size())};
    std::string bytes;
    const int width = static_cast<int>(source.width), height = static_cast<int>(source.height);
    if (!stbi_write_png_to_func(append, &bytes, width, height, source.channels, source.bytes.data(),
                                source.channels * width))
        return Error{fmt::format("a picture of {} x {} pixels cannot be encoded", width, height)};
    return bytes;
}

}  // namespace

Image8 to_srgb(const Image& image, float exposure, ToneCurve tone) {
    Image8 picture{image.width, image.height, {}};
    picture.rgb.reserve(3 * image.pixels.size());
    for (const Rgb& pixel : image.pixels)
        for (const float component : {pixel.r, pixel.g, pixel.b})
            picture.rgb.push_back(encoded(component * exposure, tone));
    return picture;
}

Result<std::string> encode_png(const Image8& picture) {
    return encode({picture.width, picture.height, 3, picture.rgb});
}

Result<std::string> encode_png(std::size_t width, std::size_t height,
                               std::span<const std::array<std::uint8_t, 4>> texels) {
    return encode({width, height, 4, {reinterpret_cast<const std::uint8_t*>(texels.data()), 4 * texels.size()}});
}

Status write_png(const std::filesystem::path& path, const Image8& picture) {
    const Result<std::string> bytes = encode_png(picture);
    if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message)};
    return write_file_atomically(path, *bytes);
}

}  // namespace lobelia
