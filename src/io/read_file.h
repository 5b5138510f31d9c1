// Files read whole, into memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// All bytes of a regular file of at most `most_bytes`. Errors name the file and the cause.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::size_t most_bytes);

/// The same of at most `most_mebibytes`, as text; any bytes may be in it.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& path, std::size_t most_mebibytes = 64);

}  // namespace lobelia
