// Shared by several verbs: grid sizes, output, progress.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "cli/output.h"
#include "io/folders.h"
#include "io/read_file.h"
#include "io/write_file.h"
#include "lobelia/environment.h"
#include "measure/progress.h"

namespace lobelia::cli {

/// Parses "256x128" as a grid of at least 1 x 1 and at most 2^26 = 67108864 texels.
[[nodiscard]] Result<LatLong> parse_grid(const std::string& text);

/// Parses "4G", "512M" or a number of bytes, at least 64 MiB; errors name the option.
[[nodiscard]] Result<std::size_t> parse_bytes(std::string_view option, const std::string& text);

/// A bar on stderr for work that takes longer than a second; null if stderr is not a terminal.
[[nodiscard]] Progress progress_bar();
/// The same with a text behind the bar.
using LabelledProgress = std::function<void(double, std::string_view)>;
[[nodiscard]] LabelledProgress labelled_progress_bar();

}  // namespace lobelia::cli
