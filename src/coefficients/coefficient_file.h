// Coefficient files: what `lobelia encode` writes and `lobelia eval` reads.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobelia/codec.h"

namespace lobelia {

/// Coefficients with the codec that they belong to.
struct CoefficientFile {
    CodecName codec;
    std::vector<Rgb> c;
};

/// The file's text, JSON.
[[nodiscard]] std::string to_text(const CoefficientFile& file);

/// Reads a coefficient file's text; `name` is what messages call it. Refuses other versions, unknown codecs, a wrong
/// number of coefficients and values that are not finite.
[[nodiscard]] Result<CoefficientFile> coefficients_from_text(std::string_view text, const std::string& name);

}  // namespace lobelia
