// Bytes as base64 (RFC 4648), for data inside pages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lobelia {

/// Writes three bytes, the first in bits 16 to 23 of `bytes`, as four characters.
void write_base64(std::uint32_t bytes, char* out);

/// All of `bytes`, padded with `=` to a multiple of four characters.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace lobelia
