// OpenEXR from any source of bytes, for the readers by path and from memory.
#pragma once

#include "io/exr_stream.h"
#include "io/read_image.h"

namespace lobelia::io {

[[nodiscard]] Result<LoadedImage> read_exr(ExrInput& in, std::string_view name, const ReadOptions& options);

}  // namespace lobelia::io
