// Irradiance of a bake, texel by texel, for comparison with the bakes of other renderers.
#pragma once

#include <filesystem>
#include <string>

#include "lobelia/bake.h"

namespace lobelia {

struct IrradianceOptions {
    std::string evaluator;  ///< another reading of the same basis; empty: the codec's own
};

/// Writes for each page a file of the page's name into `folder`, which is made if it is missing: float32 channels R, G,
/// B, the irradiance E [W/m^2] at the shading normal, and validity. Texels without a normal hold 0 in all. Returns the
/// files.
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_irradiance(const std::filesystem::path& folder,
                                                                          const Bake& bake,
                                                                          const IrradianceOptions& options = {});

}  // namespace lobelia
