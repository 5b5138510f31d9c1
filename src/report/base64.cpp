// Bytes as base64, twelve bits at a time.
#include "report/base64.h"

#include <algorithm>
#include <array>

namespace lobelia {
namespace {

/// The two characters of every 12 bits.
constexpr auto k_pairs = [] {
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::array<char, 2>, 4096> pairs{};
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {alphabet[i >> 6], alphabet[i & 63]};
    return pairs;
}();

}  // namespace

void write_base64(std::uint32_t bytes, char* out) {
    const auto &first = k_pairs[bytes >> 12], &second = k_pairs[bytes & 0xfff];
    out[0] = first[0], out[1] = first[1], out[2] = second[0], out[3] = second[1];
}

std::string base64(std::string_view bytes) {
    std::string text((bytes.size() + 2) / 3 * 4, '=');
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) -> std::uint32_t {
            return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0;
        };
        write_base64(byte(0) << 16 | byte(1) << 8 | byte(2), text.data() + i / 3 * 4);
    }
    // Replace the characters of missing bytes by padding.
    const std::size_t missing = (3 - bytes.size() % 3) % 3;
    std::fill_n(text.rbegin(), missing, '=');
    return text;
}

}  // namespace lobelia
