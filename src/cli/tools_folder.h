// The folder of the scripts and npm packages that some verbs use.
#pragma once

#include <filesystem>

#include "lobelia/result.h"

namespace lobelia::cli {

/// Returns the folder that holds unwrap.mjs: LOBELIA_TOOLS, where it is installed, or in the source tree that this
/// program was built in.
[[nodiscard]] Result<std::filesystem::path> tools_folder();

}  // namespace lobelia::cli
