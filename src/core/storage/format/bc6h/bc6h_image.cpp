// BC6H images: whole blocks from images of any size, and back. Rows of blocks start at multiples of 4; the excess of a
// block repeats the last column and row.
#include <algorithm>
#include <vector>

#include "core/math/half.h"
#include "core/storage/format/bc6h/bc6h.h"
#include "core/storage/format/format_entry.h"

namespace lobelia::bc6h {
namespace {

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

void encode(Signedness sign, std::size_t width, std::size_t height, ChannelPointers channels, std::byte* out) {
    const std::size_t blocks = (width + 3) / 4;
    std::vector<float> rows[3];
    for (auto& r : rows) r.resize(blocks * 16);
    for (std::size_t y = 0; y < height; y += 4, out += blocks * k_block_bytes) {
        // Whole blocks are read where they lie.
        const bool whole = width % 4 == 0 && y + 4 <= height;
        const float* strip[3];
        for (std::size_t k = 0; k < 3; ++k) {
            if (!whole) copy_block_row(channels[k], width, height, y, rows[k]);
            strip[k] = whole ? channels[k] + y * width : rows[k].data();
        }
        encode_blocks(strip, blocks * 4, blocks, sign, out);
    }
}

void decode(Signedness sign, std::size_t width, std::size_t height, const std::byte* bytes,
            MutableChannelPointers channels) {
    for (std::size_t y = 0; y < height; y += 4)
        for (std::size_t x = 0; x < width; x += 4, bytes += k_block_bytes) {
            const auto texels = decode_block(bytes, sign);
            for (std::size_t i = 0; i < k_texels; ++i) {
                const std::size_t column = x + i % 4, row = y + i / 4;
                if (column >= width || row >= height) continue;
                for (std::size_t k = 0; k < 3; ++k) channels[k][row * width + column] = float_from_half(texels[i][k]);
            }
        }
}

template <Signedness sign>
constexpr FormatEntry entry(std::string_view name, std::uint32_t vk_format, double lowest) {
    return {.info = {name, 3, 4, k_block_bytes, vk_format, lowest, k_largest_half},
            .encode_image = [](std::size_t width, std::size_t height, ChannelPointers channels,
                               std::byte* out) { encode(sign, width, height, channels, out); },
            .decode_image = [](std::size_t width, std::size_t height, const std::byte* bytes,
                               MutableChannelPointers channels) { decode(sign, width, height, bytes, channels); }};
}

}  // namespace
}  // namespace lobelia::bc6h

namespace lobelia::texels {

constinit const FormatEntry bc6h_unsigned = bc6h::entry<bc6h::Signedness::unsigned_halves>("bc6h_unsigned", 143, 0);
constinit const FormatEntry bc6h_signed =
    bc6h::entry<bc6h::Signedness::signed_halves>("bc6h_signed", 144, -k_largest_half);

}  // namespace lobelia::texels
