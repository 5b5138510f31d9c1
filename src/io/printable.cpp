// Decodes UTF-8 (RFC 3629) and escapes what must not reach a terminal. Which marks change the direction of text:
// Unicode Standard Annex 9.
#include "io/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace lobelia {
namespace {

/// A code point and the number of its bytes; 0 bytes if the text does not begin with UTF-8.
struct Character {
    std::uint32_t code = 0;
    std::size_t bytes = 0;
};

/// Precondition: `text` is not empty.
Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
    std::uint32_t code = lead & (0xffu >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3fu);
    }
    // Refuse overlong forms of three and four bytes (the lead byte excludes those of two), surrogates and the rest.
    const std::uint32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
    if (code < least || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return {};
    return {code, bytes};
}

/// Code points that a terminal does not show but acts on.
bool is_control(std::uint32_t code) {
    struct Range {
        std::uint32_t first, last;
    };
    constexpr Range k_ranges[] = {
        {0x00, 0x1f},      // C0
        {0x7f, 0x9f},      // DEL, C1
        {0x61c, 0x61c},    // Arabic letter mark
        {0x200e, 0x200f},  // left-to-right and right-to-left mark
        {0x2028, 0x202e},  // line and paragraph separator; embeddings and overrides
        {0x2066, 0x2069},  // isolates
    };
    return std::any_of(std::begin(k_ranges), std::end(k_ranges),
                       [&](const Range& range) { return code >= range.first && code <= range.last; });
}

std::string escaped(std::uint32_t code) {
    switch (code) {
        case '\n':
            return "\\n";
        case '\r':
            return "\\r";
        case '\t':
            return "\\t";
        default:
            return code < 0x80 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
    }
}

}  // namespace

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const Character next = first_character(text);
        if (next.bytes == 0) return false;
        text.remove_prefix(next.bytes);
    }
    return true;
}

std::string printable(std::string_view text, LineBreaks line_breaks) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Character next = first_character(text);
        const std::size_t bytes = std::max<std::size_t>(next.bytes, 1);
        if (next.bytes == 0)
            result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text[0]));
        else if (is_control(next.code) && !(next.code == '\n' && line_breaks == LineBreaks::kept))
            result += escaped(next.code);
        else
            result += text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
    return result;
}

}  // namespace lobelia
