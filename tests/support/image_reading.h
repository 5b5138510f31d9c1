// What reading an image said.
#pragma once

#include <algorithm>
#include <string>

#include "io/read_image.h"

namespace lobelia::test {

/// The error; empty if there is none.
inline std::string message_of(const Result<LoadedImage>& result) { return result ? "" : result.error().message; }

/// Whether a warning holds this text.
inline bool warns_of(const LoadedImage& loaded, const std::string& text) {
    return std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                       [&](const std::string& w) { return w.find(text) != std::string::npos; });
}

}  // namespace lobelia::test
