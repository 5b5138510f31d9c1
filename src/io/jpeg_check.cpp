// An inspection of JPEG files before stb_image decodes them, after ITU-T T.81, annex B.
#include "io/jpeg_check.h"

#include <algorithm>
#include <cstdint>

namespace lobelia::io {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::uint8_t k_start_of_image = 0xd8, k_end_of_image = 0xd9, k_start_of_scan = 0xda, k_huffman_tables = 0xc4;

std::uint8_t at(Bytes bytes, std::size_t i) { return std::to_integer<std::uint8_t>(bytes[i]); }

/// The length of the segment whose length field begins `bytes`, that field included; 0 where it is cut or no length.
std::size_t segment_length(Bytes bytes) {
    if (bytes.size() < 2) return 0;
    const std::size_t length = at(bytes, 0) * 256u + at(bytes, 1);
    return length >= 2 && length <= bytes.size() ? length : 0;
}

bool has_segment(std::uint8_t code) {
    const bool is_restart = code >= 0xd0 && code <= 0xd7;
    return !is_restart && code != k_start_of_image && code != k_end_of_image;
}

/// Whether the tables of a segment have at most 256 codes each and fill it.
bool huffman_tables_fit(Bytes bytes) {
    Bytes rest = bytes.first(segment_length(bytes));
    if (rest.empty()) return false;
    rest = rest.subspan(2);
    while (!rest.empty()) {
        constexpr std::size_t k_head = 17;  // the table's name, and how many codes there are of each length
        if (rest.size() < k_head) return false;
        std::size_t codes = 0;
        for (std::size_t i = 1; i < k_head; ++i) codes += at(rest, i);
        if (codes > 256 || k_head + codes > rest.size()) return false;
        rest = rest.subspan(k_head + codes);
    }
    return true;
}

/// Drops all before the next marker and the marker itself; its code, or nothing at the end of the bytes.
std::optional<std::uint8_t> take_marker(Bytes& bytes) {
    for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
        // Within image data 0xff is followed by 0; before a marker it may be repeated.
        if (at(bytes, i) != 0xff || at(bytes, i + 1) == 0 || at(bytes, i + 1) == 0xff) continue;
        const std::uint8_t code = at(bytes, i + 1);
        bytes = bytes.subspan(i + 2);
        return code;
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::string_view> jpeg_problem(Bytes bytes) {
    bool in_scans = false;
    while (const auto code = take_marker(bytes)) {
        if (*code == k_end_of_image && in_scans) return std::nullopt;
        if (*code == k_huffman_tables && !huffman_tables_fit(bytes)) return "a damaged Huffman table";
        in_scans = in_scans || *code == k_start_of_scan;
        // Segments may hold anything, also what looks like markers: skip them. Image data lies between segments.
        if (has_segment(*code)) bytes = bytes.subspan(segment_length(bytes));
    }
    return "the picture ends too early";
}

}  // namespace lobelia::io
