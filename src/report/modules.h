// The scripts of a report as one: ES modules joined, so that the HTML stays one file that opens from a disk.
#pragma once

#include <string>
#include <string_view>

namespace lobelia {

/// The embedded module of that path (such as "bake/bake.js") with all that it imports, each module once and after those
/// that it imports, without import and export statements: the text of one <script type="module">.
/// Preconditions: modules import by `import { a, b } from "./path.js";` alone, at the beginning of a line and without
/// renaming, have no default exports, and top-level names are unique among the modules of a report.
[[nodiscard]] std::string joined_modules(std::string_view entry);

}  // namespace lobelia
