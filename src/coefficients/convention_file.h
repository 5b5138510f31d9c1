// Coefficients of spherical harmonics in the files of others.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lobelia/sh_conventions.h"

namespace lobelia {

/// {"convention": name, and the coefficients as its form has them}. `theirs` as exported() gives it.
[[nodiscard]] nlohmann::json to_json(const ShConvention& convention, std::span<const Rgb> theirs);

/// Coefficients from such JSON, from a glTF file with EXT_lights_image_based (its first light, intensity applied), or
/// from the text that cmgen writes, a line "(r, g, b);" each. `name` is what messages call the file.
[[nodiscard]] Result<std::vector<Rgb>> convention_from_text(const ShConvention& convention, std::string_view text,
                                                            const std::string& name);

}  // namespace lobelia
