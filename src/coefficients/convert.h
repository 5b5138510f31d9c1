// Spherical harmonics from and to the conventions of others: DirectX, Unity, three.js, Filament, glTF.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/result.h"

namespace lobelia {

/// An axis of the world; mirroring one converts between right-handed and left-handed coordinates.
enum class Axis { x, y, z };

struct ConvertOptions {
    std::string from = {};              ///< convention of the input; empty: a coefficient file
    std::string to = {};                ///< convention of the output; empty: a coefficient file
    std::optional<Axis> mirrored = {};  ///< the axis to mirror
    std::string codec = {};             ///< named in a written coefficient file; empty: the first listed one
};

struct Converted {
    std::string text;                   ///< of the file to write
    std::vector<std::string> warnings;  ///< such as degrees that the convention cannot hold
};

/// Converts the text of a file; `name` is what messages call it. Error: both ends are coefficient files, an unknown
/// convention or codec, a file that does not hold what it should.
[[nodiscard]] Result<Converted> convert(std::string_view text, const std::string& name, const ConvertOptions& options);

}  // namespace lobelia
