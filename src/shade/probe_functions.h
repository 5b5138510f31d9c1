// Shader code that reads probes: the weights of ProbeVolume.
#pragma once

#include <vector>

#include "lobelia/shader_code.h"

namespace lobelia::shade {

[[nodiscard]] std::vector<ShaderFunction> probe_functions();

}  // namespace lobelia::shade
