// Shader code of octahedral texels.
#pragma once

#include <span>

#include "core/basis/octahedral.h"
#include "lobelia/shader_code.h"

namespace lobelia::octahedral {

/// The coefficient of the cell that holds w.
[[nodiscard]] Result<ShaderCode> radiance_code(const OctahedralTexels& basis);
/// Each cell as its centroid.
[[nodiscard]] Result<ShaderCode> centroid_code(std::span<const OctahedralTexels::Centroid> cells,
                                               const Rotation& map_from_domain);

}  // namespace lobelia::octahedral
