// Pixel formats: how the channels of texels become bytes and back, and how far off that is at most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "lobelia/planes.h"
#include "lobelia/shader_code.h"

namespace lobelia {

/// THE list of pixel formats. To add one, write src/core/storage/format/NAME.cpp, which defines `texels::NAME`, and put
/// the name here, at the end.
#define LOBELIA_PIXEL_FORMATS(format)                                                                            \
    format(r32f) format(rg32f) format(rgba32f) format(r16f) format(rg16f) format(rgba16f) format(r8) format(rg8) \
        format(rgba8) format(rgb10a2) format(rgb9e5) format(rgbe8) format(rgbm8) format(logluv32)                \
            format(bc6h_unsigned) format(bc6h_signed)

/// r32f, rg32f and so on: an enumerator for each name of the list.
enum class PixelFormat : std::uint8_t {
#define LOBELIA_ENUMERATOR(name) name,
    LOBELIA_PIXEL_FORMATS(LOBELIA_ENUMERATOR)
#undef LOBELIA_ENUMERATOR
};

struct FormatInfo {
    std::string_view name;
    std::size_t channels;     ///< 1 to 4
    std::size_t block;        ///< texels along one side of a block, 1 or 4
    std::size_t block_bytes;  ///< of one block
    std::uint32_t vk_format;  ///< VkFormat, as KTX 2 files name it; what has none of its own is R8G8B8A8_UNORM
    double lowest, highest;   ///< the limits of its values
};

[[nodiscard]] const FormatInfo& info(PixelFormat format);
/// Returns the shader function "vec3 decode_NAME(vec4 texel)" that decodes a texel as graphics interfaces give it in
/// the vk_format, unfiltered; null if they give the channels.
[[nodiscard]] const ShaderFunction* decode_function(PixelFormat format);
/// All formats, in the order of the list.
[[nodiscard]] std::span<const PixelFormat> pixel_formats();

/// Bytes of a width x height texture; parts of blocks count as whole ones.
[[nodiscard]] std::size_t byte_size(PixelFormat format, std::size_t width, std::size_t height);

/// One pointer to floats for each channel of a texture, row by row.
using ChannelPointers = std::span<const float* const>;
using MutableChannelPointers = std::span<float* const>;

/// Encodes width x height texels; `out` has byte_size() bytes. Values beyond the format's limits are cut to them; what
/// is not finite gives an unspecified value. Rows of blocks start at multiples of 4, and what a block has too much
/// repeats the last column and row. Bytes are in the order in which graphics interfaces upload them, little-endian.
void encode_texels(PixelFormat format, std::size_t width, std::size_t height, ChannelPointers channels,
                   std::span<std::byte> out);

/// The inverse.
void decode_texels(PixelFormat format, std::size_t width, std::size_t height, std::span<const std::byte> bytes,
                   MutableChannelPointers channels);

/// The factor by which values up to `largest` are divided before they are stored in `format`, and multiplied on
/// reading: a power of two. It is 1 where the format can hold them, but for formats whose steps are equal (rgbm8),
/// which want all of [0, 1], and for dim values (below 2^-10) in formats of half range, where they would vanish. At
/// most 2^127.
[[nodiscard]] float storing_scale(PixelFormat format, float largest);

/// The largest magnitude of `count` values.
[[nodiscard]] float largest_magnitude(const float* values, std::size_t count);

}  // namespace lobelia
