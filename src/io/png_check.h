// An inspection of PNG files before stb_image decodes them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace lobelia::io {

/// What is wrong with the chunks of a PNG file; nothing where it may be decoded. stb_image allocates what a chunk says
/// it is long, up to 2 GiB, before it asks for the bytes.
[[nodiscard]] std::optional<std::string_view> png_problem(std::span<const std::byte> bytes);

}  // namespace lobelia::io
