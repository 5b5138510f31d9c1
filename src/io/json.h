// Reads JSON from files that may be broken.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "lobelia/result.h"

namespace lobelia {

/// The content of a file's text; `name` is what messages call it. The error says at which byte, line and column it
/// stops to be JSON, and why.
[[nodiscard]] Result<nlohmann::json> checked_json(std::string_view text, const std::string& name);

}  // namespace lobelia
