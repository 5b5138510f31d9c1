// A bake as a folder, written together with other files there.
#pragma once

#include "bake/write/files_together.h"
#include "lobelia/bake.h"

namespace lobelia {

/// Adds the files of a bake to `files`, and commits them together with what is there already.
[[nodiscard]] Result<Manifest> write_bake(FilesTogether files, const Bake& bake, const WriteBakeOptions& options);

}  // namespace lobelia
