// Lists of numbers on the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lobelia::cli {

/// Returns finite numbers with commas between them, or nothing where the text is anything else.
[[nodiscard]] std::optional<std::vector<float>> parse_numbers(const std::string& text);

}  // namespace lobelia::cli
