// Names of codecs in untrusted files.
#pragma once

#include <string_view>

#include "lobelia/codec.h"

namespace lobelia {

/// Parses the name of a codec from a file. An error for a name that would open another file ("sg:FILE"): a bake opens
/// only its own.
[[nodiscard]] Result<CodecName> stored_codec_name(std::string_view name);

}  // namespace lobelia
