// The table of pixel formats, and encoding and decoding by it.
#include "lobelia/pixel_format.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/storage/format/bc6h/bc6h.h"
#include "core/storage/format/floats.h"
#include "core/storage/format/logluv.h"
#include "core/storage/format/rgb9e5.h"
#include "core/storage/format/rgbe.h"
#include "core/storage/format/rgbm.h"
#include "core/storage/format/unorm.h"

namespace lobelia {
namespace {

using EncodeGroups = void (*)(const float* const* channels, std::size_t count, std::byte* out);
using DecodeGroups = void (*)(const std::byte* bytes, std::size_t count, float* const* channels);
using EncodeImage = void (*)(std::size_t width, std::size_t height, ChannelPointers channels, std::byte* out);
using DecodeImage = void (*)(std::size_t width, std::size_t height, const std::byte* bytes, MutableChannelPointers out);

/// Values are divided by a scale if they exceed the format's limits, or always, so that they fill [0, 1].
enum class Scaling { if_needed, always };

/// A format with its kernels: of texels, k_lanes at a time, or of whole images where texels come in blocks.
struct Entry {
    PixelFormat format;
    FormatInfo info;
    EncodeGroups encode = nullptr;
    DecodeGroups decode = nullptr;
    EncodeImage encode_image = nullptr;
    DecodeImage decode_image = nullptr;
    Scaling scaling = Scaling::if_needed;
};

template <std::size_t channels, auto kernel>
void encode_with(const float* const* in, std::size_t count, std::byte* out) {
    kernel(channels, in, count, out);
}
template <std::size_t channels, auto kernel>
void decode_with(const std::byte* bytes, std::size_t count, float* const* out) {
    kernel(channels, bytes, count, out);
}

constexpr double k_float_max = std::numeric_limits<float>::max();

template <std::size_t channels>
constexpr Entry floats(PixelFormat format, std::string_view name, std::uint32_t vk_format) {
    return {format,
            {name, channels, 1, 4 * channels, vk_format, -k_float_max, k_float_max},
            encode_with<channels, texels::encode_floats>,
            decode_with<channels, texels::decode_floats>};
}
template <std::size_t channels>
constexpr Entry halves(PixelFormat format, std::string_view name, std::uint32_t vk_format) {
    return {format,
            {name, channels, 1, 2 * channels, vk_format, -k_largest_half, k_largest_half},
            encode_with<channels, texels::encode_halves>,
            decode_with<channels, texels::decode_halves>};
}
template <std::size_t channels>
constexpr Entry unorm8(PixelFormat format, std::string_view name, std::uint32_t vk_format) {
    return {format,
            {name, channels, 1, channels, vk_format, 0, 1},
            encode_with<channels, texels::encode_unorm8>,
            decode_with<channels, texels::decode_unorm8>};
}

using F = PixelFormat;

/// THE list, in the order of PixelFormat. The fields of FormatInfo: name, channels, side and bytes of a block,
/// VkFormat, limits.
constexpr std::array k_formats = {
    floats<1>(F::r32f, "r32f", 100),
    floats<2>(F::rg32f, "rg32f", 103),
    floats<4>(F::rgba32f, "rgba32f", 109),
    halves<1>(F::r16f, "r16f", 76),
    halves<2>(F::rg16f, "rg16f", 83),
    halves<4>(F::rgba16f, "rgba16f", 97),
    unorm8<1>(F::r8, "r8", 9),
    unorm8<2>(F::rg8, "rg8", 16),
    unorm8<4>(F::rgba8, "rgba8", 37),
    Entry{F::rgb10a2, {"rgb10a2", 3, 1, 4, 64, 0, 1}, texels::encode_unorm10, texels::decode_unorm10},
    Entry{
        F::rgb9e5, {"rgb9e5", 3, 1, 4, 123, 0, texels::k_largest_rgb9e5}, texels::encode_rgb9e5, texels::decode_rgb9e5},
    Entry{F::rgbe8, {"rgbe8", 3, 1, 4, 37, 0, texels::k_largest_rgbe}, texels::encode_rgbe, texels::decode_rgbe},
    Entry{F::rgbm8,
          {"rgbm8", 3, 1, 4, 37, 0, 1},
          texels::encode_rgbm,
          texels::decode_rgbm,
          nullptr,
          nullptr,
          Scaling::always},
    Entry{F::logluv32, {"logluv32", 3, 1, 4, 37, 0, 0x1p60}, texels::encode_logluv, texels::decode_logluv},
    Entry{F::bc6h_unsigned,
          {"bc6h_unsigned", 3, 4, bc6h::k_block_bytes, 143, 0, k_largest_half},
          nullptr,
          nullptr,
          bc6h::encode_unsigned,
          bc6h::decode_unsigned},
    Entry{F::bc6h_signed,
          {"bc6h_signed", 3, 4, bc6h::k_block_bytes, 144, -k_largest_half, k_largest_half},
          nullptr,
          nullptr,
          bc6h::encode_signed,
          bc6h::decode_signed},
};

constexpr auto k_in_order = [] {
    std::array<PixelFormat, k_formats.size()> formats{};
    for (std::size_t i = 0; i < formats.size(); ++i) formats[i] = k_formats[i].format;
    return formats;
}();
static_assert(
    [] {
        for (std::size_t i = 0; i < k_in_order.size(); ++i)
            if (static_cast<std::size_t>(k_in_order[i]) != i) return false;
        return true;
    }(),
    "k_formats is in the order of PixelFormat");

const Entry& entry_of(PixelFormat format) { return k_formats[static_cast<std::size_t>(format)]; }

bool is_aligned(const std::byte* bytes) { return reinterpret_cast<std::uintptr_t>(bytes) % 4 == 0; }

/// A group of texels apart, for the end of a row of them, or for bytes that are not aligned.
struct Group {
    alignas(64) float values[4][k_lanes] = {};
    alignas(64) std::byte bytes[k_lanes * 16] = {};
    float* channels[4] = {values[0], values[1], values[2], values[3]};
};

void encode_plain(const Entry& entry, std::size_t count, ChannelPointers channels, std::byte* out) {
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

void decode_plain(const Entry& entry, std::size_t count, const std::byte* bytes, MutableChannelPointers channels) {
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

std::span<const PixelFormat> pixel_formats() { return k_in_order; }

std::size_t byte_size(PixelFormat format, std::size_t width, std::size_t height) {
    const FormatInfo& f = info(format);
    return (width + f.block - 1) / f.block * ((height + f.block - 1) / f.block) * f.block_bytes;
}

void encode_texels(PixelFormat format, std::size_t width, std::size_t height, ChannelPointers channels,
                   std::span<std::byte> out) {
    const Entry& entry = entry_of(format);
    check_equal("channels", channels.size(), entry.info.channels);
    check_equal("bytes", out.size(), byte_size(format, width, height));
    if (entry.encode)
        encode_plain(entry, width * height, channels, out.data());
    else
        entry.encode_image(width, height, channels, out.data());
}

void decode_texels(PixelFormat format, std::size_t width, std::size_t height, std::span<const std::byte> bytes,
                   MutableChannelPointers channels) {
    const Entry& entry = entry_of(format);
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
    if (!(largest > 0) || (!always && largest <= limit)) return 1;
    // The least power of two that brings `largest` to the limit or below.
    int exponent = 0;
    const double share = std::frexp(static_cast<double>(largest) / limit, &exponent);
    if (share == 0.5) --exponent;
    return std::ldexp(1.0f, std::clamp(exponent, -126, 127));
}

float largest_magnitude(const float* values, std::size_t count) { return texels::largest_magnitude(values, count); }

}  // namespace lobelia
