// An inspection of OpenEXR headers before OpenEXR itself parses them, for it allocates what they ask for.
#pragma once

#include "io/exr_stream.h"
#include "io/read_image.h"

namespace lobelia::io {

/// Walks the attributes of every part and refuses files whose attributes do not fit their stated sizes or the file, or
/// whose parts exceed the limits of `options`: data windows, tiles; or have too many channels. Leaves `in` at its
/// beginning.
[[nodiscard]] Status check_exr_headers(ExrInput& in, std::string_view name, const ReadOptions& options,
                                       std::size_t most_channels = 256);

}  // namespace lobelia::io
