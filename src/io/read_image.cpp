// Environments from files: chooses the reader by the content of the file.
#include "io/read_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "io/decode_picture.h"
#include "io/image_checks.h"

namespace lobelia {

namespace {

enum class Format { radiance, openexr, picture };

/// Enough bytes to recognise every format.
constexpr std::size_t k_magic_bytes = 12;

std::optional<Format> format_of(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("#?")) return Format::radiance;
    if (text.starts_with("\x76\x2f\x31\x01")) return Format::openexr;
    if (io::picture_format(bytes)) return Format::picture;
    return std::nullopt;
}

Error unknown_format(std::string_view name, std::span<const std::byte> begin) {
    if (begin.empty()) return Error{fmt::format("{}: the file is empty", name)};
    if (const std::string_view format = io::unread_format(begin); !format.empty())
        return Error{
            fmt::format("{}: {} is not supported; use Radiance .hdr, OpenEXR, PNG, JPEG or WebP", name, format)};
    return Error{fmt::format("{}: neither a Radiance picture, nor OpenEXR, nor PNG, JPEG or WebP", name)};
}

}  // namespace

Result<LoadedImage> read_environment(const std::filesystem::path& path, const ReadOptions& options) {
    // Open the file and recognise its format.
    auto file = InputFile::open(path);
    if (!file) return file.error();
    std::vector<std::byte> begin(static_cast<std::size_t>(std::min<std::uint64_t>(k_magic_bytes, file->size())));
    if (const Status status = file->read(0, begin); !status) return status.error();
    const std::optional<Format> format = format_of(begin);
    if (!format) return unknown_format(file->name(), begin);

    // Read OpenEXR in place, all else whole.
    if (*format == Format::openexr) return read_exr(*std::move(file), options);
    // No format takes more than 16 bytes for a pixel; the rest is for headers.
    constexpr std::size_t k_most_pixels = std::size_t{io::k_most_side} * io::k_most_side;
    const std::size_t most_bytes = 16 * std::min(options.most_pixels, k_most_pixels) + (std::size_t{64} << 20);
    if (file->size() > most_bytes) return Error{fmt::format("{}: larger than {} bytes", file->name(), most_bytes)};
    const auto bytes = read_file(*file);
    if (!bytes) return bytes.error();
    return read_environment(*bytes, file->name(), options);
}

Result<LoadedImage> read_environment(std::span<const std::byte> bytes, std::string_view name,
                                     const ReadOptions& options) {
    const std::optional<Format> format = format_of(bytes);
    if (!format) return unknown_format(name, bytes.first(std::min(bytes.size(), k_magic_bytes)));
    switch (*format) {
        case Format::radiance:
            return read_hdr(bytes, name, options);
        case Format::openexr:
            return read_exr(bytes, name, options);
        case Format::picture:
            break;
    }
    return read_ldr(bytes, name, options);
}

}  // namespace lobelia
