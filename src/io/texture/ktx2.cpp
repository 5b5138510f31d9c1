// KTX 2.0 files, after "KTX File Format Specification, Version 2.0" (Khronos 2021) and "Khronos Data Format
// Specification, version 1.3" (2019), chapter 5.
#include "io/texture/ktx2.h"

#include <fmt/format.h>
#include <zstd.h>

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <vector>

#include "io/texture/bytes.h"

namespace lobelia {
namespace {

// Channels of the model RGBSDA; BC6H has one, 0. Qualifiers stand beside them.
constexpr std::array<std::uint32_t, 4> k_rgba = {0, 1, 2, 15};
constexpr std::uint32_t k_exponent = 0x20, k_signed = 0x40, k_float = 0x80;
constexpr std::uint32_t k_one = std::bit_cast<std::uint32_t>(1.0f), k_minus_one = std::bit_cast<std::uint32_t>(-1.0f);

/// Bits of a block that hold a channel, and the stored values that mean -1 or 0 (lower) and 1 (upper).
struct Sample {
    std::uint32_t first_bit, bits, channel;  ///< with qualifiers
    std::uint32_t lower, upper;
};

/// Description of a pixel format in the file, besides its VkFormat.
struct FormatFacts {
    std::uint32_t model = 1;       ///< RGBSDA, or 133, BC6H
    std::uint32_t type_bytes = 1;  ///< size of the unit that byte swapping reverses
    std::vector<Sample> samples;
};

/// Channels of equal size, starting at bit 0.
FormatFacts floats(std::uint32_t count, std::uint32_t bits) {
    FormatFacts facts{1, bits / 8, {}};
    for (std::uint32_t i = 0; i < count; ++i)
        facts.samples.push_back({i * bits, bits, k_rgba[i] | k_float | k_signed, k_minus_one, k_one});
    return facts;
}
FormatFacts bytes(std::uint32_t count) {
    FormatFacts facts;
    for (std::uint32_t i = 0; i < count; ++i) facts.samples.push_back({i * 8, 8, k_rgba[i], 0, 255});
    return facts;
}

FormatFacts ten_bits() {
    return {1, 4, {{0, 10, 0, 0, 1023}, {10, 10, 1, 0, 1023}, {20, 10, 2, 0, 1023}, {30, 2, 15, 0, 3}}};
}

/// Each colour has nine bits of its own, and the five of the exponent, whose bias is 15. The bounds are those that the
/// specification gives for this very format.
FormatFacts shared_exponent() {
    FormatFacts facts{1, 4, {}};
    for (std::uint32_t i = 0; i < 3; ++i) {
        facts.samples.push_back({9 * i, 9, i, 0, 8448});
        facts.samples.push_back({27, 5, i | k_exponent, 15, 31});
    }
    return facts;
}

FormatFacts bc6h(std::uint32_t qualifiers) {
    constexpr std::uint32_t k_model_bc6h = 133;
    return {k_model_bc6h, 1, {{0, 128, k_float | qualifiers, qualifiers == k_signed ? k_minus_one : 0, k_one}}};
}

/// Returns the facts of a VkFormat. Pixel formats without their own, stored as R8G8B8A8_UNORM, need no entry.
FormatFacts facts_of(std::uint32_t vk_format) {
    switch (vk_format) {
        case 100:
            return floats(1, 32);
        case 103:
            return floats(2, 32);
        case 109:
            return floats(4, 32);
        case 76:
            return floats(1, 16);
        case 83:
            return floats(2, 16);
        case 97:
            return floats(4, 16);
        case 9:
            return bytes(1);
        case 16:
            return bytes(2);
        case 37:
            return bytes(4);
        case 64:
            return ten_bits();
        case 123:
            return shared_exponent();
        case 143:
            return bc6h(0);
        case 144:
            return bc6h(k_signed);
        default:
            assert(false);
            return {};
    }
}

/// The basic data format descriptor.
Bytes descriptor(const FormatFacts& facts, const FormatInfo& format, bool compressed) {
    const std::size_t block = 24 + 16 * facts.samples.size();
    Bytes bytes;
    bytes.u32(4 + block);
    bytes.u32(0);                                             // vendor Khronos, basic format
    bytes.u32(2 | block << 16);                               // version 1.3
    bytes.u32(facts.model | 1 << 8 | 1 << 16);                // primaries of BT.709, linear, straight alpha
    bytes.u32((format.block - 1) | (format.block - 1) << 8);  // texels of a block, less one
    bytes.u64(compressed ? 0 : format.block_bytes);           // bytes of plane 0, if known; there are no others
    for (const Sample& sample : facts.samples) {
        bytes.u32(sample.first_bit | (sample.bits - 1) << 16 | sample.channel << 24);
        bytes.u32(0);  // at the block's place
        bytes.u32(sample.lower);
        bytes.u32(sample.upper);
    }
    return bytes;
}

/// Keys and values, sorted by key.
Bytes key_values(const TextureFile& texture) {
    std::map<std::string, std::string> metadata = texture.metadata;
    // Cube maps have an orientation of their own, which needs no key.
    if (texture.faces == 1) metadata["KTXorientation"] = texture.depth > 0 ? "rdi" : "rd";
    metadata["KTXwriter"] = "Lobelia " LOBELIA_VERSION;
    Bytes bytes;
    for (const auto& [key, value] : metadata) {
        bytes.u32(key.size() + 1 + value.size() + 1);
        bytes.text(key + '\0' + value + '\0');
        bytes.pad_to(4);
    }
    return bytes;
}

/// A level as the file holds it.
struct StoredLevel {
    std::span<const std::byte> bytes;
    std::vector<std::byte> compressed;  ///< the owner of `bytes`, if they are
};

/// Compresses a level in one frame of zstd, which is what the scheme asks for.
Result<std::vector<std::byte>> compressed(std::span<const std::byte> bytes) {
    constexpr int k_effort = 9;
    std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), k_effort);
    if (ZSTD_isError(size) != 0) return Error{fmt::format("zstd: {}", ZSTD_getErrorName(size))};
    out.resize(size);
    return out;
}

Result<std::vector<StoredLevel>> stored_levels(const TextureFile& texture) {
    std::vector<StoredLevel> stored;
    for (const auto& level : texture.levels) {
        StoredLevel& entry = stored.emplace_back(StoredLevel{level, {}});
        if (!texture.compressed) continue;
        auto bytes = compressed(level);
        if (!bytes) return bytes.error();
        entry.compressed = *std::move(bytes);
        entry.bytes = entry.compressed;
    }
    return stored;
}

/// Levels begin at a multiple of the block size and of 4, unless they are compressed.
std::size_t alignment_of(const TextureFile& texture) {
    return texture.compressed ? 1 : std::lcm(info(texture.format).block_bytes, std::size_t{4});
}

/// Everything before the texels.
Bytes beginning(const TextureFile& texture, const std::vector<StoredLevel>& levels) {
    constexpr std::size_t k_header = 80, k_level = 24, k_zstd = 2;
    const FormatInfo& format = info(texture.format);
    const FormatFacts facts = facts_of(info(texture.format).vk_format);
    const Bytes described = descriptor(facts, format, texture.compressed), metadata = key_values(texture);
    const std::size_t format_begin = k_header + k_level * levels.size(),
                      metadata_begin = format_begin + described.size();
    const std::size_t alignment = alignment_of(texture);
    const auto aligned = [&](std::size_t at) { return (at + alignment - 1) / alignment * alignment; };

    // The smallest level stands first, so that a file that arrives in parts can be shown early.
    std::vector<std::size_t> begins(levels.size());
    std::size_t end = metadata_begin + metadata.size();
    for (std::size_t i = levels.size(); i-- > 0; end = begins[i] + levels[i].bytes.size()) begins[i] = aligned(end);

    Bytes bytes;
    bytes.text("\xabKTX 20\xbb\r\n\x1a\n");
    for (const std::size_t value :
         {std::size_t{format.vk_format}, std::size_t{facts.type_bytes}, texture.width, texture.height, texture.depth,
          texture.layers, texture.faces, levels.size(), texture.compressed ? k_zstd : 0, format_begin, described.size(),
          metadata_begin, metadata.size()})
        bytes.u32(value);
    for (std::uint64_t value : {0, 0}) bytes.u64(value);  // no data of the scheme that levels share
    for (std::size_t i = 0; i < levels.size(); ++i)
        for (const std::size_t value : {begins[i], levels[i].bytes.size(), texture.levels[i].size()}) bytes.u64(value);
    bytes.append(described);
    bytes.append(metadata);
    return bytes;
}

}  // namespace

Status write_ktx2(StagedFile& file, const TextureFile& texture) {
    const auto levels = stored_levels(texture);
    if (!levels) return levels.error();
    Bytes bytes = beginning(texture, *levels);
    std::size_t end = bytes.size();
    if (auto status = file.write(bytes.data()); !status) return status;
    for (std::size_t i = levels->size(); i-- > 0;) {
        const std::size_t gap = (alignment_of(texture) - end % alignment_of(texture)) % alignment_of(texture);
        const std::vector<std::byte> zeros(gap);
        if (auto status = file.write(zeros); !status) return status;
        if (auto status = file.write((*levels)[i].bytes); !status) return status;
        end += gap + (*levels)[i].bytes.size();
    }
    return Done{};
}

}  // namespace lobelia
