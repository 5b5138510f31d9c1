// The table of pixel formats, and encoding and decoding by it.
#include "lobelia/pixel_format.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

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

/// A format with its kernels; formats of blocks have none for texels.
struct Entry {
    FormatInfo info;
    EncodeGroups encode = nullptr;
    DecodeGroups decode = nullptr;
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
constexpr Entry floats(std::string_view name, std::uint32_t vk_format) {
    return {{name, channels, 1, 4 * channels, vk_format, -k_float_max, k_float_max},
            encode_with<channels, texels::encode_floats>,
            decode_with<channels, texels::decode_floats>};
}
template <std::size_t channels>
constexpr Entry halves(std::string_view name, std::uint32_t vk_format) {
    return {{name, channels, 1, 2 * channels, vk_format, -k_largest_half, k_largest_half},
            encode_with<channels, texels::encode_halves>,
            decode_with<channels, texels::decode_halves>};
}
template <std::size_t channels>
constexpr Entry unorm8(std::string_view name, std::uint32_t vk_format) {
    return {{name, channels, 1, channels, vk_format, 0, 1},
            encode_with<channels, texels::encode_unorm8>,
            decode_with<channels, texels::decode_unorm8>};
}

/// In the order of PixelFormat.
constexpr std::array k_formats = {
    floats<1>("r32f", 100),
    floats<2>("rg32f", 103),
    floats<4>("rgba32f", 109),
    halves<1>("r16f", 76),
    halves<2>("rg16f", 83),
    halves<4>("rgba16f", 97),
    unorm8<1>("r8", 9),
    unorm8<2>("rg8", 16),
    unorm8<4>("rgba8", 37),
    Entry{{"rgb10a2", 3, 1, 4, 64, 0, 1}, texels::encode_unorm10, texels::decode_unorm10},
    Entry{{"rgb9e5", 3, 1, 4, 123, 0, texels::k_largest_rgb9e5}, texels::encode_rgb9e5, texels::decode_rgb9e5},
    Entry{{"rgbe8", 3, 1, 4, 37, 0, texels::k_largest_rgbe}, texels::encode_rgbe, texels::decode_rgbe},
    Entry{{"rgbm8", 3, 1, 4, 37, 0, 1}, texels::encode_rgbm, texels::decode_rgbm},
    Entry{{"logluv32", 3, 1, 4, 37, 0, 0x1p60}, texels::encode_logluv, texels::decode_logluv},
    Entry{{"bc6h_unsigned", 3, 4, bc6h::k_block_bytes, 143, 0, k_largest_half}},
    Entry{{"bc6h_signed", 3, 4, bc6h::k_block_bytes, 144, -k_largest_half, k_largest_half}},
};

const Entry& entry_of(PixelFormat format) { return k_formats[static_cast<std::size_t>(format)]; }

bc6h::Signedness sign_of(PixelFormat format) {
    return format == PixelFormat::bc6h_signed ? bc6h::Signedness::signed_halves : bc6h::Signedness::unsigned_halves;
}

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

/// Four rows from y on, widened to whole blocks by repeating the last column and row.
void copy_block_row(const float* channel, std::size_t width, std::size_t height, std::size_t y, std::span<float> out) {
    const std::size_t stride = out.size() / 4;
    for (std::size_t row = 0; row < 4; ++row) {
        const float* from = channel + std::min(y + row, height - 1) * width;
        float* to = out.data() + row * stride;
        std::copy_n(from, width, to);
        std::fill_n(to + width, stride - width, from[width - 1]);
    }
}

void encode_bc6h(PixelFormat format, std::size_t width, std::size_t height, ChannelPointers channels, std::byte* out) {
    const std::size_t blocks = (width + 3) / 4;
    std::vector<float> rows[3];
    for (auto& r : rows) r.resize(blocks * 16);
    for (std::size_t y = 0; y < height; y += 4, out += blocks * bc6h::k_block_bytes) {
        // Whole blocks are read where they lie.
        const bool whole = width % 4 == 0 && y + 4 <= height;
        const float* strip[3];
        for (std::size_t k = 0; k < 3; ++k) {
            if (!whole) copy_block_row(channels[k], width, height, y, rows[k]);
            strip[k] = whole ? channels[k] + y * width : rows[k].data();
        }
        bc6h::encode_blocks(strip, blocks * 4, blocks, sign_of(format), out);
    }
}

void decode_bc6h(PixelFormat format, std::size_t width, std::size_t height, const std::byte* bytes,
                 MutableChannelPointers channels) {
    for (std::size_t y = 0; y < height; y += 4)
        for (std::size_t x = 0; x < width; x += 4, bytes += bc6h::k_block_bytes) {
            const auto texels = bc6h::decode_block(bytes, sign_of(format));
            for (std::size_t i = 0; i < bc6h::k_texels; ++i) {
                const std::size_t column = x + i % 4, row = y + i / 4;
                if (column >= width || row >= height) continue;
                for (std::size_t k = 0; k < 3; ++k) channels[k][row * width + column] = float_from_half(texels[i][k]);
            }
        }
}

}  // namespace

const FormatInfo& info(PixelFormat format) { return entry_of(format).info; }

std::size_t byte_size(PixelFormat format, std::size_t width, std::size_t height) {
    const FormatInfo& f = info(format);
    return (width + f.block - 1) / f.block * ((height + f.block - 1) / f.block) * f.block_bytes;
}

void encode_texels(PixelFormat format, std::size_t width, std::size_t height, ChannelPointers channels,
                   std::span<std::byte> out) {
    const Entry& entry = entry_of(format);
    assert(channels.size() == entry.info.channels && out.size() == byte_size(format, width, height));
    if (entry.encode)
        encode_plain(entry, width * height, channels, out.data());
    else
        encode_bc6h(format, width, height, channels, out.data());
}

void decode_texels(PixelFormat format, std::size_t width, std::size_t height, std::span<const std::byte> bytes,
                   MutableChannelPointers channels) {
    const Entry& entry = entry_of(format);
    assert(channels.size() == entry.info.channels && bytes.size() == byte_size(format, width, height));
    if (entry.decode)
        decode_plain(entry, width * height, bytes.data(), channels);
    else
        decode_bc6h(format, width, height, bytes.data(), channels);
}

float storing_scale(PixelFormat format, float largest) {
    const double limit = info(format).highest;
    const bool wants_all = format == PixelFormat::rgbm8;
    if (!(largest > 0) || (!wants_all && largest <= limit)) return 1;
    // The least power of two that brings `largest` to the limit or below.
    int exponent = 0;
    const double share = std::frexp(static_cast<double>(largest) / limit, &exponent);
    if (share == 0.5) --exponent;
    return std::ldexp(1.0f, std::clamp(exponent, -126, 127));
}

float largest_magnitude(const float* values, std::size_t count) { return texels::largest_magnitude(values, count); }

}  // namespace lobelia
