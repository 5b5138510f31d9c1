// An inspection of PNG files before stb_image decodes them, after ISO/IEC 15948, chapter 5.
#include "io/png_check.h"

#include <cstdint>

namespace lobelia::io {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t k_signature = 8;
/// Length and name before a chunk's data, checksum after.
constexpr std::size_t k_head = 8, k_tail = 4;

/// Four bytes, the highest first.
std::uint32_t big_endian(Bytes bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
    return value;
}

constexpr std::uint32_t k_end = 0x49454e44;  // "IEND"

}  // namespace

std::optional<std::string_view> png_problem(Bytes bytes) {
    constexpr std::string_view k_cut = "the picture ends too early";
    if (bytes.size() < k_signature) return k_cut;
    Bytes rest = bytes.subspan(k_signature);
    while (rest.size() >= k_head) {
        const std::size_t length = big_endian(rest);
        if (big_endian(rest.subspan(4)) == k_end) return std::nullopt;
        if (length > rest.size() - k_head) return "a chunk is longer than the file";
        if (rest.size() - k_head - length < k_tail) return k_cut;
        rest = rest.subspan(k_head + length + k_tail);
    }
    return k_cut;
}

}  // namespace lobelia::io
