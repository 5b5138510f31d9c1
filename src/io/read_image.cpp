// Environments from files: the choice of a format by content, and the reading of bytes.
#include "io/read_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>

#include "io/image_checks.h"
#include "io/read_exr.h"

namespace lobelia {

namespace {

enum class Format { radiance, openexr, picture };

/// Enough of a file to tell its format.
constexpr std::size_t k_magic_bytes = 4;

std::optional<Format> format_of(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("#?")) return Format::radiance;
    if (text.starts_with("\x76\x2f\x31\x01")) return Format::openexr;
    if (text.starts_with("\x89PNG") || text.starts_with("\xff\xd8\xff") || text.starts_with("BM"))
        return Format::picture;
    return std::nullopt;
}

Error unknown_format(std::string_view name, std::size_t bytes) {
    if (bytes == 0) return Error{fmt::format("{}: the file is empty", name)};
    return Error{fmt::format("{}: neither a Radiance picture, nor OpenEXR, nor PNG, JPEG or BMP", name)};
}

Error system_error(std::string_view name, int code) {
    return Error{fmt::format("{}: cannot be read: {}", name, std::generic_category().message(code))};
}

/// A file opened for reading, with its first bytes.
struct OpenFile {
    io::FileInput::Handle handle;
    std::vector<std::byte> begin;
};

Result<OpenFile> open(const std::filesystem::path& path, std::string_view name) {
    std::error_code code;
    if (std::filesystem::is_directory(path, code)) return Error{fmt::format("{}: a folder, not an image", name)};
    errno = 0;
    OpenFile file{io::FileInput::Handle(std::fopen(path.c_str(), "rb"), std::fclose),
                  std::vector<std::byte>(k_magic_bytes)};
    if (!file.handle) return system_error(name, errno);
    file.begin.resize(std::fread(file.begin.data(), 1, file.begin.size(), file.handle.get()));
    if (std::ferror(file.handle.get())) return system_error(name, errno);
    return file;
}

/// All of a file of about `size_hint` bytes, also of one without a size such as a pipe.
Result<std::vector<std::byte>> read_all(OpenFile file, std::size_t size_hint, std::string_view name,
                                        const ReadOptions& options) {
    // No format takes more bytes for a pixel; the rest is for headers.
    constexpr std::size_t k_most_pixels = std::size_t{io::k_most_side} * io::k_most_side;
    const std::size_t most_bytes = 16 * std::min(options.most_pixels, k_most_pixels) + (std::size_t{64} << 20);
    constexpr std::size_t k_step = std::size_t{1} << 20;
    std::vector<std::byte> bytes = std::move(file.begin);
    bytes.reserve(std::min(size_hint + k_step, most_bytes));
    for (;;) {
        const std::size_t old_size = bytes.size();
        bytes.resize(std::max(old_size + k_step, bytes.capacity()));
        const std::size_t read = std::fread(bytes.data() + old_size, 1, bytes.size() - old_size, file.handle.get());
        bytes.resize(old_size + read);
        if (std::ferror(file.handle.get())) return system_error(name, errno);
        if (bytes.size() > most_bytes) return Error{fmt::format("{}: larger than {} bytes", name, most_bytes)};
        if (read == 0) return bytes;
    }
}

}  // namespace

Result<LoadedImage> read_environment(const std::filesystem::path& path, const ReadOptions& options) {
    // Open the file and learn its format.
    const std::string name = path.string();
    Result<OpenFile> file = open(path, name);
    if (!file) return file.error();
    const std::optional<Format> format = format_of(file->begin);
    if (!format) return unknown_format(name, file->begin.size());

    // Read OpenEXR in place, and all else whole.
    std::error_code code;
    const bool regular = std::filesystem::is_regular_file(path, code);
    const std::uintmax_t size = regular ? std::filesystem::file_size(path, code) : 0;
    if (regular && code) return system_error(name, code.value());
    if (regular && *format == Format::openexr) {
        std::rewind(file->handle.get());
        io::FileInput in(std::move(file->handle), size, name);
        return io::read_exr(in, name, options);
    }
    const Result<std::vector<std::byte>> bytes = read_all(std::move(*file), size, name, options);
    if (!bytes) return bytes.error();
    return read_environment(*bytes, name, options);
}

Result<LoadedImage> read_environment(std::span<const std::byte> bytes, std::string_view name,
                                     const ReadOptions& options) {
    const std::optional<Format> format = format_of(bytes);
    if (!format) return unknown_format(name, bytes.size());
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
