// KTX 2.0 files, after "KTX File Format Specification, Version 2.0" (Khronos 2021) and "Khronos Data Format
// Specification" (2019), chapter 5.
#include "io/write_ktx2.h"

#include <OpenEXR/ImfRgba.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "io/image_checks.h"

namespace lobelia {
namespace {

constexpr std::size_t k_most_layers = 2048;

/// What the file says of a texel format.
struct FormatFacts {
    std::uint32_t vk_format;
    std::uint32_t component_bytes;
    std::uint32_t channel_flags;  ///< of the data format descriptor: float, signed
    std::uint32_t lowest, highest;
};

FormatFacts facts_of(TexelFormat format) {
    // VK_FORMAT_R16G16B16A16_SFLOAT from -1 to 1, VK_FORMAT_R8G8B8A8_UNORM from 0 to 255: what counts as 1.
    if (format == TexelFormat::half) return {97, 2, 0xc0, std::bit_cast<std::uint32_t>(-1.0f), 0x3f800000};
    return {37, 1, 0, 0, 255};
}

/// Bytes in the file's order, little-endian.
class Bytes {
  public:
    void u32(std::uint64_t value) { number(value, 4); }
    void u64(std::uint64_t value) { number(value, 8); }
    void text(std::string_view text) {
        for (char c : text) data_.push_back(static_cast<std::byte>(c));
    }
    void pad_to(std::size_t multiple) {
        while (data_.size() % multiple != 0) data_.push_back(std::byte{0});
    }
    void append(const Bytes& other) { data_.insert(data_.end(), other.data_.begin(), other.data_.end()); }
    [[nodiscard]] std::size_t size() const { return data_.size(); }
    [[nodiscard]] std::span<const std::byte> data() const { return data_; }

  private:
    void number(std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) data_.push_back(static_cast<std::byte>(value >> (8 * i) & 0xff));
    }
    std::vector<std::byte> data_;
};

/// The basic data format descriptor: four channels of one kind side by side.
Bytes descriptor(const FormatFacts& facts) {
    constexpr std::array<std::uint32_t, 4> k_channels = {0, 1, 2, 15};  // R, G, B, A of the model RGBSDA
    constexpr std::uint32_t k_block = 24 + 16 * k_channels.size();
    Bytes bytes;
    bytes.u32(4 + k_block);
    bytes.u32(0);                          // vendor Khronos, basic format
    bytes.u32(2 | k_block << 16);          // version 1.3
    bytes.u32(1 | 1 << 8 | 1 << 16);       // model RGBSDA, primaries of BT.709, linear, straight alpha
    bytes.u32(0);                          // blocks of 1 x 1 texel
    bytes.u64(4 * facts.component_bytes);  // bytes of plane 0; there are no others
    for (std::uint32_t i = 0; i < k_channels.size(); ++i) {
        const std::uint32_t bits = 8 * facts.component_bytes;
        bytes.u32(i * bits | (bits - 1) << 16 | (k_channels[i] | facts.channel_flags) << 24);
        bytes.u32(0);  // at the texel's place
        bytes.u32(facts.lowest);
        bytes.u32(facts.highest);
    }
    return bytes;
}

/// Keys and values, sorted by key.
Bytes key_values(std::map<std::string, std::string> metadata) {
    metadata["KTXorientation"] = "rd";
    metadata["KTXwriter"] = "Lobelia " LOBELIA_VERSION;
    Bytes bytes;
    for (const auto& [key, value] : metadata) {
        bytes.u32(key.size() + 1 + value.size() + 1);
        bytes.text(key + '\0' + value + '\0');
        bytes.pad_to(4);
    }
    return bytes;
}

/// All before the texels; they begin at a multiple of a texel's size, which is one of 4.
Bytes beginning(const Ktx2Texture& texture, const FormatFacts& facts, std::uint64_t texel_bytes) {
    constexpr std::size_t k_header = 80, k_level = 24;
    const Bytes format = descriptor(facts), metadata = key_values(texture.metadata);
    const std::size_t format_begin = k_header + k_level, metadata_begin = format_begin + format.size();
    const std::size_t alignment = 4 * facts.component_bytes;
    const std::size_t texels_begin = (metadata_begin + metadata.size() + alignment - 1) / alignment * alignment;
    Bytes bytes;
    bytes.text("\xabKTX 20\xbb\r\n\x1a\n");
    for (std::uint64_t value : {std::uint64_t{facts.vk_format}, std::uint64_t{facts.component_bytes},
                                std::uint64_t{texture.width}, std::uint64_t{texture.height}})
        bytes.u32(value);
    for (std::uint64_t value : {std::uint64_t{0}, std::uint64_t{texture.layers}}) bytes.u32(value);  // depth, layers
    for (std::uint64_t value : {1, 1, 0}) bytes.u32(value);  // faces, levels, no supercompression
    for (std::size_t value : {format_begin, format.size(), metadata_begin, metadata.size()}) bytes.u32(value);
    for (std::uint64_t value : {std::uint64_t{0}, std::uint64_t{0}}) bytes.u64(value);  // no supercompression data
    for (std::uint64_t value : {std::uint64_t{texels_begin}, texel_bytes, texel_bytes}) bytes.u64(value);
    bytes.append(format);
    bytes.append(metadata);
    bytes.pad_to(alignment);
    return bytes;
}

void store(std::span<const Rgba> texels, TexelFormat format, std::byte* target) {
    for (const Rgba& texel : texels)
        for (const float value : texel) {
            if (format == TexelFormat::half) {
                const half stored(std::isfinite(value) ? std::clamp(value, -65504.0f, 65504.0f) : value);
                const std::uint16_t bits = stored.bits();
                std::memcpy(target, &bits, sizeof bits);
                target += sizeof bits;
            } else {
                const float cut = value > 0 ? std::min(value, 1.0f) : 0.0f;
                *target++ = static_cast<std::byte>(std::lround(cut * 255));
            }
        }
}

}  // namespace

Status write_ktx2(StagedFile& file, const Ktx2Texture& texture,
                  const std::function<void(std::size_t y, std::span<Rgba> texels)>& fill) {
    const auto [width, height, layers] = std::array{texture.width, texture.height, texture.layers};
    constexpr auto k_most_side = static_cast<std::size_t>(io::k_most_side);
    if (width == 0 || height == 0 || width > k_most_side || height > k_most_side || layers == 0 ||
        layers > k_most_layers)
        return Error{fmt::format("a texture of {} x {} texels and {} layers cannot be written", width, height, layers)};
    const FormatFacts facts = facts_of(texture.format);
    const std::size_t row_bytes = width * 4 * facts.component_bytes;
    const Bytes begin = beginning(texture, facts, row_bytes * height * layers);
    if (auto status = file.write(begin.data()); !status) return status;

    // Gather some rows of all layers, then write each layer's part of them where it belongs.
    constexpr std::size_t k_most_gathered = std::size_t{1} << 24;
    const std::size_t band = std::clamp<std::size_t>(k_most_gathered / (row_bytes * layers), 1, height);
    std::vector<Rgba> row(width * layers);
    std::vector<std::byte> rows(row_bytes * layers * band);
    for (std::size_t y = 0; y < height; y += band) {
        const std::size_t count = std::min(band, height - y);
        for (std::size_t i = 0; i < count; ++i) {
            fill(y + i, row);
            for (std::size_t layer = 0; layer < layers; ++layer)
                store(std::span(row).subspan(layer * width, width), texture.format,
                      rows.data() + (layer * band + i) * row_bytes);
        }
        for (std::size_t layer = 0; layer < layers; ++layer) {
            const std::span part(rows.data() + layer * band * row_bytes, count * row_bytes);
            auto status = file.seek(begin.size() + (layer * height + y) * row_bytes);
            if (status) status = file.write(part);
            if (!status) return status;
        }
    }
    return Done{};
}

}  // namespace lobelia
