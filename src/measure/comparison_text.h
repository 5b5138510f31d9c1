// A comparison as text for people.
#pragma once

#include <string>

#include "measure/comparison.h"

namespace lobelia {

/// A table of the best codec of each basis, by irradiance error; of a recipe, of all its methods.
[[nodiscard]] std::string summary_text(const Comparison& comparison);

/// A table of what was stored: for each number of bytes with a smaller irradiance error than any before, the codec and
/// storage that reach it. Storages whose texels share blocks are left out: single texels say nothing about them. Empty
/// if nothing was stored.
[[nodiscard]] std::string stored_text(const Comparison& comparison);

}  // namespace lobelia
