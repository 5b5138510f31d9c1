// WebP by libwebp.
#include <fmt/format.h>
#include <webp/decode.h>

#include <limits>

#include "io/decode_picture.h"

namespace lobelia::io {

namespace {

std::string_view reason(VP8StatusCode status) {
    switch (status) {
        case VP8_STATUS_OUT_OF_MEMORY:
            return "no memory for its decoder";
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return "a feature that libwebp does not support";
        case VP8_STATUS_SUSPENDED:
        case VP8_STATUS_NOT_ENOUGH_DATA:
            return "the file ends too early";
        default:
            return "its bit stream is invalid";
    }
}

}  // namespace

Result<Picture> decode_webp(std::span<const std::byte> bytes, std::string_view name, const PictureOptions& options) {
    const auto damaged = [&](VP8StatusCode status) {
        return Error{fmt::format("{}: damaged WebP: {}", name, reason(status))};
    };
    const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) return Error{fmt::format("{}: libwebp has another version", name)};
    if (const VP8StatusCode status = WebPGetFeatures(data, bytes.size(), &config.input); status != VP8_STATUS_OK)
        return damaged(status);
    if (config.input.has_animation)
        return Error{fmt::format("{}: an animated WebP; only still pictures are supported", name)};

    // Check the size. A picture of one colour takes the same few bytes at any size.
    constexpr std::size_t k_any = std::numeric_limits<std::size_t>::max();
    const auto [width, height] = std::pair(config.input.width, config.input.height);
    const Status size = check_picture_size(name, width, height, bytes.size(), k_any, options);
    if (!size) return size.error();

    // Decode into the texels.
    auto texels = filled<Rgba8>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), options);
    config.output.colorspace = MODE_RGBA;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = texels.data()->data();
    config.output.u.RGBA.stride = static_cast<int>(sizeof(Rgba8)) * width;
    config.output.u.RGBA.size = texels.size() * sizeof(Rgba8);
    if (const VP8StatusCode status = WebPDecode(data, bytes.size(), &config); status != VP8_STATUS_OK)
        return damaged(status);
    return Picture{static_cast<std::size_t>(width), static_cast<std::size_t>(height), std::move(texels)};
}

}  // namespace lobelia::io
