// Pictures inside pages.
#include "report/picture.h"

#include <cassert>
#include <nlohmann/json.hpp>

#include "report/base64.h"
#include "report/page_template.h"

namespace lobelia {
namespace {

/// Writes a pixel's six bytes, little-endian halves, as eight characters; so no pixel ever needs padding.
void write_pixel(Rgb pixel, char* out) {
    const std::uint32_t r = half_from_float(pixel.r), g = half_from_float(pixel.g), b = half_from_float(pixel.b);
    write_base64((r & 0xff) << 16 | (r >> 8) << 8 | (g & 0xff), out);
    write_base64((g >> 8) << 16 | (b & 0xff) << 8 | b >> 8, out + 4);
}

template <class PixelAt>
Picture encode(std::size_t width, std::size_t height, const PixelAt& pixel_at) {
    Picture picture{width, height, std::string(width * height * 8, '\0')};
    for (std::size_t i = 0; i < width * height; ++i) write_pixel(pixel_at(i), picture.data.data() + i * 8);
    return picture;
}

/// One channel: two bytes a pixel, which base64 cuts as it comes.
template <class ValueAt>
Picture encode_values(std::size_t width, std::size_t height, Picture::Values values, const ValueAt& value_at) {
    std::string bytes(width * height * 2, '\0');
    for (std::size_t i = 0; i < width * height; ++i) {
        const std::uint16_t value = value_at(i);
        bytes[2 * i] = static_cast<char>(value & 0xff);
        bytes[2 * i + 1] = static_cast<char>(value >> 8);
    }
    return {width, height, base64(bytes), 1, values};
}

}  // namespace

Picture encode_picture(std::span<const Rgb> pixels, std::size_t width, std::size_t height) {
    assert(pixels.size() == width * height);
    return encode(width, height, [&](std::size_t i) { return pixels[i]; });
}

Picture encode_picture(const ColourView& pixels, std::size_t width, std::size_t height) {
    assert(pixels.size == width * height);
    return encode(width, height, [&](std::size_t i) { return colour_at(pixels, i); });
}

Picture encode_picture(std::span<const float> pixels, std::size_t width, std::size_t height) {
    assert(pixels.size() == width * height);
    return encode_values(width, height, Picture::Values::half,
                         [&](std::size_t i) { return half_from_float(pixels[i]); });
}

Picture encode_picture(std::span<const std::uint16_t> pixels, std::size_t width, std::size_t height) {
    assert(pixels.size() == width * height);
    return encode_values(width, height, Picture::Values::whole, [&](std::size_t i) { return pixels[i]; });
}

void write_picture(const Picture& picture, std::string& json) {
    json += "{\"width\":" + std::to_string(picture.width) + ",\"height\":" + std::to_string(picture.height);
    if (picture.channels != 3) json += ",\"channels\":" + std::to_string(picture.channels);
    json += picture.values == Picture::Values::half ? ",\"half\":\"" : ",\"whole\":\"";
    json += picture.data;
    json += "\"}";
}

void write_pictures(const std::map<std::string, Picture>& pictures, std::string& json) {
    char separator = '{';
    for (const auto& [name, picture] : pictures) {
        ((json += separator) += '\n') += script_safe(name);
        json += ':';
        write_picture(picture, json);
        separator = ',';
    }
    json += pictures.empty() ? "{}" : "}";
}

std::size_t written_bytes(const Picture& picture) {
    constexpr std::size_t k_around = 128;  // its name and its sizes
    return picture.data.size() + k_around;
}

std::size_t written_bytes(const std::map<std::string, Picture>& pictures) {
    std::size_t total = 0;
    for (const auto& [name, picture] : pictures) total += written_bytes(picture);
    return total;
}

}  // namespace lobelia
