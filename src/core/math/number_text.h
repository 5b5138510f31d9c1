// Numbers as text for people.
#pragma once

#include <string>

namespace lobelia {

/// Formats a number for tables: `digits` significant digits, as "3.1e-4" below 1e-2.
[[nodiscard]] std::string table_number(double value, int digits = 2);

}  // namespace lobelia
