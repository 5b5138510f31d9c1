// A check that the chunks of an OpenEXR part decode to as many bytes as their pixels take. OpenEXR does not make it for
// every compression, and gives memory that nothing was written to for the pixels that are missing.
#pragma once

#include <OpenEXR/ImfInputPart.h>

#include <string_view>

#include "io/exr_checks.h"

namespace lobelia::io {

/// Decodes every chunk of full resolution once more, as far as its length needs. An error names the first scan line or
/// tile that has too few bytes or too many. Other faults of the file are exceptions of OpenEXR. Leaves `in` where it
/// was.
[[nodiscard]] Status check_chunks(ExrInput& in, const ExrHeaders& headers, Imf::InputPart& part, std::string_view name);

}  // namespace lobelia::io
