// PNG pictures by libpng, encoded in memory and written atomically.
#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <new>

#include "core/math/colour.h"
#include "io/escape.h"
#include "io/image_checks.h"
#include "io/write_file.h"
#include "io/write_image.h"

namespace lobelia {

namespace {

std::uint8_t encoded(float linear, ToneCurve tone) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(toned(tone, static_cast<double>(linear)))));
}

struct PngSource {
    std::size_t width, height;
    std::size_t channels;  ///< 3 or 4
    std::span<const std::uint8_t> bytes;
};

/// State of libpng and the bytes that it has written.
struct PngWriter {
    PngWriter() = default;
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }

    png_structp png = nullptr;
    png_infop info = nullptr;
    io::Escape escape;
    std::string bytes;
};

[[noreturn]] void leave(png_structp png, png_const_charp message) {
    static_cast<PngWriter*>(png_get_error_ptr(png))->escape.leave(message);
}
void ignore_warning(png_structp, png_const_charp) {}

bool appended(std::string& target, png_bytep data, std::size_t size) {
    try {
        target.append(reinterpret_cast<const char*>(data), size);
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

void put_bytes(png_structp png, png_bytep data, std::size_t size) {
    auto& writer = *static_cast<PngWriter*>(png_get_io_ptr(png));
    if (!appended(writer.bytes, data, size)) writer.escape.leave("no memory for the encoded picture");
}

void write(PngWriter& writer, const PngSource& source) {
    writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, leave, ignore_warning);
    writer.info = writer.png ? png_create_info_struct(writer.png) : nullptr;
    if (!writer.info) writer.escape.leave("no memory for its encoder");
    png_set_write_fn(writer.png, &writer, put_bytes, nullptr);
    png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(source.width),
                 static_cast<png_uint_32>(source.height), 8,
                 source.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(writer.png, writer.info);
    for (std::size_t y = 0; y < source.height; ++y)
        png_write_row(writer.png, source.bytes.data() + y * source.width * source.channels);
    png_write_end(writer.png, nullptr);
}

Result<std::string> encode(const PngSource& source) {
    constexpr auto k_most_side = static_cast<std::size_t>(io::k_most_side);
    if (source.width == 0 || source.height == 0 || source.width > k_most_side || source.height > k_most_side ||
        source.bytes.size() != source.channels * source.width * source.height)
        return Error{fmt::format("a picture of {} x {} pixels in {} bytes cannot be written", source.width,
                                 source.height, source.bytes.size())};
    PngWriter writer;
    if (!writer.escape.run([&] { write(writer, source); }))
        return Error{fmt::format("a picture of {} x {} pixels cannot be encoded: {}", source.width, source.height,
                                 writer.escape.message())};
    return std::move(writer.bytes);
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
