// Text files, whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "lobelia/result.h"

namespace lobelia {

/// The whole of a regular file of at most `most_mebibytes`; any bytes. Errors name the file and the cause.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& path, std::uintmax_t most_mebibytes = 64);

}  // namespace lobelia
