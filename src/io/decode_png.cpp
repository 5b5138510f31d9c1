// PNG by libpng.
#include <fmt/format.h>
#include <png.h>

#include <bit>
#include <cstring>

#include "io/decode_picture.h"
#include "io/escape.h"
#include "io/image_checks.h"

namespace lobelia::io {

namespace {

/// State of libpng and of the bytes that it reads.
struct PngReader {
    explicit PngReader(std::span<const std::byte> bytes) : rest(bytes) {}
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

    png_structp png = nullptr;
    png_infop info = nullptr;
    Escape escape;
    std::span<const std::byte> rest;
};

/// Also called for warnings: with the chunks about colour ignored, all that are left mean damaged data.
[[noreturn]] void leave(png_structp png, png_const_charp message) {
    static_cast<PngReader*>(png_get_error_ptr(png))->escape.leave(message);
}
void leave_on_warning(png_structp png, png_const_charp message) { leave(png, message); }

void take_bytes(png_structp png, png_bytep target, std::size_t count) {
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader.rest.size()) reader.escape.leave("the file ends too early");
    std::memcpy(target, reader.rest.data(), count);
    reader.rest = reader.rest.subspan(count);
}

/// Reads all before the pixels, without any chunk that does not change what is stored (text, time, gamma, profiles).
void read_header(PngReader& reader) {
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, leave, leave_on_warning);
    reader.info = reader.png ? png_create_info_struct(reader.png) : nullptr;
    if (!reader.info) reader.escape.leave("no memory for its decoder");
    png_set_read_fn(reader.png, &reader, take_bytes);
    png_set_user_limits(reader.png, k_most_side, k_most_side);
    png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_benign_errors(reader.png, 0);
    png_read_info(reader.png, reader.info);
}

/// Reads the pixels as RGBA of 8 or 16 bits into rows, and the rest of the file.
void read_rows(PngReader& reader, bool sixteen_bits, png_bytepp rows, std::size_t row_bytes) {
    png_set_expand(reader.png);
    png_set_gray_to_rgb(reader.png);
    png_set_add_alpha(reader.png, 0xffff, PNG_FILLER_AFTER);
    if (!sixteen_bits) png_set_strip_16(reader.png);
    if (sixteen_bits && std::endian::native == std::endian::little) png_set_swap(reader.png);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    if (png_get_rowbytes(reader.png, reader.info) != row_bytes) reader.escape.leave("rows of an unexpected size");
    png_read_image(reader.png, rows);
    png_read_end(reader.png, nullptr);
}

template <class Texel>
bool read_texels(PngReader& reader, std::size_t width, std::size_t height, std::vector<Texel>& texels) {
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = reinterpret_cast<png_bytep>(texels.data() + y * width);
    return reader.escape.run(
        [&] { read_rows(reader, sizeof(Texel) == sizeof(Rgba16), rows.data(), width * sizeof(Texel)); });
}

}  // namespace

Result<Picture> decode_png(std::span<const std::byte> bytes, std::string_view name, const PictureOptions& options) {
    PngReader reader(bytes);
    const auto damaged = [&] {
        return Error{fmt::format("{}: damaged PNG: {}, at byte {} of {}", name, reader.escape.message(),
                                 bytes.size() - reader.rest.size(), bytes.size())};
    };
    if (!reader.escape.run([&] { read_header(reader); })) return damaged();

    // Check the size. PNG packs at best 8 pixels into a byte, and deflates 1032 : 1.
    const std::int64_t width = png_get_image_width(reader.png, reader.info);
    const std::int64_t height = png_get_image_height(reader.png, reader.info);
    const Status size = check_picture_size(name, width, height, bytes.size(), 8 * 1032, options);
    if (!size) return size.error();

    // Decode.
    Picture picture{static_cast<std::size_t>(width), static_cast<std::size_t>(height), {}};
    const bool sixteen_bits =
        options.depth == PictureOptions::Depth::stored && png_get_bit_depth(reader.png, reader.info) == 16;
    if (sixteen_bits)
        picture.texels = filled<Rgba16>(picture.width * picture.height, options);
    else
        picture.texels = filled<Rgba8>(picture.width * picture.height, options);
    const bool done = std::visit(
        [&](auto& texels) { return read_texels(reader, picture.width, picture.height, texels); }, picture.texels);
    if (!done) return damaged();
    return picture;
}

}  // namespace lobelia::io
