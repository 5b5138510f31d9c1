// Pixel formats by the list, and encoding and decoding with their kernels.
#include "lobelia/pixel_format.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/math/half.h"
#include "core/storage/format/floats.h"
#include "core/storage/format/format_entry.h"

namespace lobelia {
namespace {

#define LOBELIA_ENTRY(name) &texels::name,
constexpr std::array k_entries = {LOBELIA_PIXEL_FORMATS(LOBELIA_ENTRY)};
#undef LOBELIA_ENTRY

#define LOBELIA_FORMAT(name) PixelFormat::name,
constexpr std::array k_formats = {LOBELIA_PIXEL_FORMATS(LOBELIA_FORMAT)};
#undef LOBELIA_FORMAT

const FormatEntry& entry_of(PixelFormat format) { return *k_entries[static_cast<std::size_t>(format)]; }

bool is_aligned(const std::byte* bytes) { return reinterpret_cast<std::uintptr_t>(bytes) % 4 == 0; }

/// A group of texels apart, for the end of a row of them, or for bytes that are not aligned.
struct Group {
    alignas(64) float values[4][k_lanes] = {};
    alignas(64) std::byte bytes[k_lanes * 16] = {};
    float* channels[4] = {values[0], values[1], values[2], values[3]};
};

void encode_plain(const FormatEntry& entry, std::size_t count, ChannelPointers channels, std::byte* out) {
    const std::size_t whole = is_aligned(out) ? count / k_lanes * k_lanes : 0;
    if (whole > 0) entry.encode(channels.data(), whole, out);
    Group group;
    for (std::size_t begin = whole; begin < count; begin += k_lanes) {
        const std::size_t size = std::min(k_lanes, count - begin);
        for (std::size_t k = 0; k < channels.size(); ++k) std::copy_n(channels[k] + begin, size, group.values[k]);
        entry.encode(group.channels, k_lanes, group.bytes);
        std::copy_n(group.bytes, size * entry.info.block_bytes, out + begin * entry.info.block_bytes);
    }
}

void decode_plain(const FormatEntry& entry, std::size_t count, const std::byte* bytes,
                  MutableChannelPointers channels) {
    const std::size_t whole = is_aligned(bytes) ? count / k_lanes * k_lanes : 0;
    if (whole > 0) entry.decode(bytes, whole, channels.data());
    Group group;
    for (std::size_t begin = whole; begin < count; begin += k_lanes) {
        const std::size_t size = std::min(k_lanes, count - begin);
        std::copy_n(bytes + begin * entry.info.block_bytes, size * entry.info.block_bytes, group.bytes);
        entry.decode(group.bytes, k_lanes, group.channels);
        for (std::size_t k = 0; k < channels.size(); ++k) std::copy_n(group.values[k], size, channels[k] + begin);
    }
}

}  // namespace

const FormatInfo& info(PixelFormat format) { return entry_of(format).info; }

const ShaderFunction* decode_function(PixelFormat format) {
    const auto function = entry_of(format).shader_decode;
    return function ? &function() : nullptr;
}

std::span<const PixelFormat> pixel_formats() { return k_formats; }

std::size_t byte_size(PixelFormat format, std::size_t width, std::size_t height) {
    const FormatInfo& f = info(format);
    return (width + f.block - 1) / f.block * ((height + f.block - 1) / f.block) * f.block_bytes;
}

void encode_texels(PixelFormat format, std::size_t width, std::size_t height, ChannelPointers channels,
                   std::span<std::byte> out) {
    const FormatEntry& entry = entry_of(format);
    check_equal("channels", channels.size(), entry.info.channels);
    check_equal("bytes", out.size(), byte_size(format, width, height));
    if (entry.encode)
        encode_plain(entry, width * height, channels, out.data());
    else
        entry.encode_image(width, height, channels, out.data());
}

void decode_texels(PixelFormat format, std::size_t width, std::size_t height, std::span<const std::byte> bytes,
                   MutableChannelPointers channels) {
    const FormatEntry& entry = entry_of(format);
    check_equal("channels", channels.size(), entry.info.channels);
    check_equal("bytes", bytes.size(), byte_size(format, width, height));
    if (entry.decode)
        decode_plain(entry, width * height, bytes.data(), channels);
    else
        entry.decode_image(width, height, bytes.data(), channels);
}

float storing_scale(PixelFormat format, float largest) {
    const double limit = info(format).highest;
    const bool always = entry_of(format).scaling == Scaling::always;
    // Halves, blocks of them and rgb9e5 end at about 2^-24: dim values are brought to 1.
    const bool ends_early = limit > 1 && limit <= static_cast<double>(k_largest_half) * 1.01;
    const bool dim = ends_early && largest < k_dim_for_half;
    if (!(largest > 0) || (!always && !dim && largest <= limit)) return 1;
    // The least power of two that brings `largest` to the limit or below.
    int exponent = 0;
    const double share = std::frexp(static_cast<double>(largest) / (dim ? 1 : limit), &exponent);
    if (share == 0.5) --exponent;
    return std::ldexp(1.0f, std::clamp(exponent, -126, 127));
}

float largest_magnitude(const float* values, std::size_t count) { return texels::largest_magnitude(values, count); }

}  // namespace lobelia
