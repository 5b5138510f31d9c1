// Pictures inside pages: half floats or whole numbers as base64, which the page's scripts decode.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "core/math/half.h"
#include "lobelia/planes.h"

namespace lobelia {

/// A picture as the page takes it: base64 of little-endian 16-bit values, row by row, channel by channel within a
/// pixel. A pixel of three has 8 characters.
struct Picture {
    enum class Values { half, whole };  ///< float16, or unsigned
    std::size_t width = 0;
    std::size_t height = 0;
    std::string data;
    std::size_t channels = 3;
    Values values = Values::half;
};

/// Encodes linear pixels, row by row from the top left. Precondition: as many pixels as `width` x `height`.
[[nodiscard]] Picture encode_picture(std::span<const Rgb> pixels, std::size_t width, std::size_t height);
[[nodiscard]] Picture encode_picture(const ColourView& pixels, std::size_t width, std::size_t height);
/// One channel.
[[nodiscard]] Picture encode_picture(std::span<const float> pixels, std::size_t width, std::size_t height);
/// One channel of whole numbers.
[[nodiscard]] Picture encode_picture(std::span<const std::uint16_t> pixels, std::size_t width, std::size_t height);

/// Appends a picture as JSON, by hand: base64 needs no escapes, and many megabytes of it should be copied once.
void write_picture(const Picture& picture, std::string& json);
/// Appends an object of pictures by their names.
void write_pictures(const std::map<std::string, Picture>& pictures, std::string& json);
/// About how many bytes these two append.
[[nodiscard]] std::size_t written_bytes(const Picture& picture);
[[nodiscard]] std::size_t written_bytes(const std::map<std::string, Picture>& pictures);

}  // namespace lobelia
