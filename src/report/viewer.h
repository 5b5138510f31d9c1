// A folder that shows a bake in a browser, by three.js.
#pragma once

#include <filesystem>

#include "core/stop.h"
#include "lobelia/result.h"

namespace lobelia {

/// Writes a page, the package lobelia-three, the parts of three.js that it uses, and a copy of the bake's files. Any
/// static HTTP server shows the folder; nothing else is loaded. `three` is the folder of three.js's npm package.
/// Errors: a bake without a copy of its scene, without textures or without shader code, which the page cannot show;
/// files of three.js that are missing.
[[nodiscard]] Status write_viewer(const std::filesystem::path& bake, const std::filesystem::path& three,
                                  const std::filesystem::path& folder, StopFlag stop = {});

}  // namespace lobelia
