// The files of a reflection probe.
#pragma once

#include <filesystem>
#include <string>

#include "measure/prefilter.h"

namespace lobelia {

/// What prefilter.json says of where the levels come from, and the format of the cube map.
struct PrefilterFiles {
    std::string source, at;          ///< the environment or the scene, and the place in it
    std::string format = "rgba16f";  ///< a pixel format by name
    PrefilterOptions options;        ///< with which the levels were made
};

/// Writes specular.ktx2, the levels as a cube map; split-sum.ktx2; irradiance.json, harmonics of the radiance; and
/// prefilter.json, all of them together.
[[nodiscard]] Status write_prefilter(const std::filesystem::path& folder, const Image& radiance,
                                     const std::vector<CubeLevel>& levels, const PrefilterFiles& about);

}  // namespace lobelia
