// A pixel format as its file defines it: its facts and its kernels.
#pragma once

#include "lobelia/pixel_format.h"
#include "lobelia/shader_code.h"

namespace lobelia {

/// Values are divided by a scale if they exceed the format's limits, or always, so that they fill [0, 1].
enum class Scaling { if_needed, always };

/// Either the two kernels of texels, or, where texels come in blocks, the two functions of whole images.
struct FormatEntry {
    FormatInfo info;
    /// `count` is a multiple of k_lanes, bytes are aligned to 4; one pointer to floats for each channel.
    void (*encode)(const float* const* channels, std::size_t count, std::byte* out) = nullptr;
    void (*decode)(const std::byte* bytes, std::size_t count, float* const* channels) = nullptr;
    void (*encode_image)(std::size_t width, std::size_t height, ChannelPointers channels, std::byte* out) = nullptr;
    void (*decode_image)(std::size_t width, std::size_t height, const std::byte* bytes,
                         MutableChannelPointers channels) = nullptr;
    Scaling scaling = Scaling::if_needed;
    /// "vec3 decode_NAME(vec4 texel)", where graphics interfaces give something else than the channels.
    const ShaderFunction& (*shader_decode)() = nullptr;
};

namespace texels {

// texels::r32f and so on, each defined in the file of its format.
#define LOBELIA_DECLARE_FORMAT(name) extern const FormatEntry name;
LOBELIA_PIXEL_FORMATS(LOBELIA_DECLARE_FORMAT)
#undef LOBELIA_DECLARE_FORMAT

/// A kernel for any number of channels as one for a fixed number.
template <std::size_t channels, auto kernel>
void encode_with(const float* const* in, std::size_t count, std::byte* out) {
    kernel(channels, in, count, out);
}
template <std::size_t channels, auto kernel>
void decode_with(const std::byte* bytes, std::size_t count, float* const* out) {
    kernel(channels, bytes, count, out);
}

}  // namespace texels
}  // namespace lobelia
