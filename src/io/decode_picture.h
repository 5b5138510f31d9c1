// PNG, JPEG and WebP decoders over libpng, libjpeg-turbo and libwebp, with one contract. Safe on any bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lobelia/result.h"

namespace lobelia::io {

enum class PictureFormat { png, jpeg, webp };

/// Recognises a picture by its first bytes (12 are enough).
[[nodiscard]] std::optional<PictureFormat> picture_format(std::span<const std::byte> bytes);

/// Recognises some formats that are not read, such as "a BMP picture"; empty for all others.
[[nodiscard]] std::string_view unread_format(std::span<const std::byte> bytes);

using Rgba8 = std::array<std::uint8_t, 4>;
using Rgba16 = std::array<std::uint16_t, 4>;

/// Red, green, blue, alpha as stored, row by row from the top left.
struct Picture {
    std::size_t width = 0;
    std::size_t height = 0;
    std::variant<std::vector<Rgba8>, std::vector<Rgba16>> texels;
};

struct PictureOptions {
    /// Larger pictures are refused before their pixels are allocated.
    std::size_t most_pixels = std::size_t{1} << 28;
    /// 16 bits a sample only if the file has them (PNG) and this is `stored`; else their upper 8.
    enum class Depth { eight, stored };
    Depth depth = Depth::eight;
    /// Every byte of the texels before decoding. No picture depends on it, for the decoders write all; tests compare.
    std::uint8_t fill = 0;
};

/// Decodes PNG, JPEG or WebP; the content decides which. Grey becomes R = G = B, palettes their colours, missing alpha
/// the largest value; CMYK is converted without a colour profile. Orientation, gamma and colour profiles in the file
/// are ignored. Errors begin with `name`: truncated files, and every warning of a library that means damaged data.
[[nodiscard]] Result<Picture> decode_picture(std::span<const std::byte> bytes, std::string_view name,
                                             const PictureOptions& options);

/// The decoders of one format each.
[[nodiscard]] Result<Picture> decode_png(std::span<const std::byte> bytes, std::string_view name,
                                         const PictureOptions& options);
[[nodiscard]] Result<Picture> decode_jpeg(std::span<const std::byte> bytes, std::string_view name,
                                          const PictureOptions& options);
[[nodiscard]] Result<Picture> decode_webp(std::span<const std::byte> bytes, std::string_view name,
                                          const PictureOptions& options);

/// The texels before decoding: every byte is options.fill.
template <class Texel>
[[nodiscard]] std::vector<Texel> filled(std::size_t count, const PictureOptions& options) {
    Texel texel;
    std::memset(texel.data(), options.fill, sizeof texel);
    return std::vector<Texel>(count, texel);
}

/// Returns an error if a picture of this size is empty, exceeds the limits, or cannot be held by `bytes` bytes at
/// `most_pixels_per_byte`, the best compression of its format.
[[nodiscard]] Status check_picture_size(std::string_view name, std::int64_t width, std::int64_t height,
                                        std::size_t bytes, std::size_t most_pixels_per_byte,
                                        const PictureOptions& options);

}  // namespace lobelia::io
