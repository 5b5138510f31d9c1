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

#include <algorithm>
#include <array>

#include "io/image_checks.h"
#include "io/write_file.h"
#include "io/write_image.h"
#include "lobelia/colour.h"

namespace lobelia {

namespace {

std::uint8_t encoded(float linear) {
    // Written so that NaN becomes black.
    const float cut = linear > 0 ? std::min(linear, 1.0f) : 0.0f;
    return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(cut)));
}

void append(void* target, void* data, int size) {
    static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

Image8 to_srgb(const Image& image, float exposure) {
    Image8 picture{image.width, image.height, {}};
    picture.rgb.reserve(3 * image.pixels.size());
    for (const Rgb& pixel : image.pixels)
        for (const float component : {pixel.r, pixel.g, pixel.b}) picture.rgb.push_back(encoded(component * exposure));
    return picture;
}

Result<std::string> encode_png(const Image8& picture) {
    // stb_image_write counts bytes in int.
    constexpr std::size_t k_most_pixels = std::size_t{1} << 28;
    const std::size_t pixels = picture.width * picture.height;
    if (pixels == 0 || picture.width > io::k_most_side || picture.height > io::k_most_side || pixels > k_most_pixels ||
        picture.rgb.size() != 3 * pixels)
        return Error{fmt::format("a picture of {} x {} pixels in {} bytes cannot be written", picture.width,
                                 picture.height, picture.rgb.size())};
    std::string bytes;
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    if (!stbi_write_png_to_func(append, &bytes, width, height, 3, picture.rgb.data(), 3 * width))
        return Error{fmt::format("a picture of {} x {} pixels cannot be encoded", width, height)};
    return bytes;
}

Status write_png(const std::filesystem::path& path, const Image8& picture) {
    const Result<std::string> bytes = encode_png(picture);
    if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message)};
    return write_file_atomically(path, *bytes);
}

}  // namespace lobelia
