// An inspection of JPEG files before stb_image decodes them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace lobelia::io {

/// What is wrong with the segments of a JPEG file; nothing where it may be decoded. stb_image fills images that end too
/// early with grey, and releases up to 2.28 write Huffman tables of more than 256 codes beyond the room that they have.
[[nodiscard]] std::optional<std::string_view> jpeg_problem(std::span<const std::byte> bytes);

}  // namespace lobelia::io
