// Recognises pictures and passes them to the decoder of their format.
#include "io/decode_picture.h"

#include <fmt/format.h>

#include "io/image_checks.h"

namespace lobelia::io {

namespace {

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::optional<PictureFormat> picture_format(std::span<const std::byte> bytes) {
    const std::string_view text = text_of(bytes);
    if (text.starts_with("\x89PNG")) return PictureFormat::png;
    if (text.starts_with("\xff\xd8\xff")) return PictureFormat::jpeg;
    if (text.starts_with("RIFF") && text.substr(4).substr(0, 8).ends_with("WEBP")) return PictureFormat::webp;
    return std::nullopt;
}

std::string_view unread_format(std::span<const std::byte> bytes) {
    using namespace std::string_view_literals;
    const std::string_view text = text_of(bytes);
    if (text.starts_with("BM")) return "a BMP picture";
    if (text.starts_with("GIF8")) return "a GIF picture";
    if (text.starts_with("II*\0"sv) || text.starts_with("MM\0*"sv)) return "a TIFF picture";
    if (text.starts_with("\xabKTX ")) return "a KTX file";
    if (text.starts_with("DDS ")) return "a DDS file";
    if (text.starts_with("\xff\x0a"sv) || text.starts_with("\0\0\0\x0cJXL "sv)) return "a JPEG XL picture";
    if (text.starts_with("\0\0\0\x0cjP"sv)) return "a JPEG 2000 picture";
    if (text.size() >= 12 && text.substr(4, 4) == "ftyp") return "an AVIF or HEIF picture";
    return "";
}

Status check_picture_size(std::string_view name, std::int64_t width, std::int64_t height, std::size_t bytes,
                          std::size_t most_pixels_per_byte, const PictureOptions& options) {
    ReadOptions limits;
    limits.most_pixels = options.most_pixels;
    if (const Status status = check_size(name, width, height, limits); !status) return status;
    if (static_cast<std::size_t>(width * height) / most_pixels_per_byte > bytes)
        return Error{fmt::format("{}: {} bytes cannot hold {} x {} pixels", name, bytes, width, height)};
    return Done{};
}

Result<Picture> decode_picture(std::span<const std::byte> bytes, std::string_view name, const PictureOptions& options) {
    const auto format = picture_format(bytes);
    if (bytes.empty()) return Error{fmt::format("{}: empty", name)};
    if (!format && !unread_format(bytes).empty())
        return Error{fmt::format("{}: {} is not supported; use PNG, JPEG or WebP", name, unread_format(bytes))};
    if (!format) return Error{fmt::format("{}: neither PNG nor JPEG nor WebP", name)};
    switch (*format) {
        case PictureFormat::png:
            return decode_png(bytes, name, options);
        case PictureFormat::jpeg:
            return decode_jpeg(bytes, name, options);
        case PictureFormat::webp:
            break;
    }
    return decode_webp(bytes, name, options);
}

}  // namespace lobelia::io
