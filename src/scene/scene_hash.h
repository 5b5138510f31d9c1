// A scene's hash: the same for the same content, on every machine and in every build.
#pragma once

#include <cstdint>

#include "lobelia/scene.h"

namespace lobelia {

/// Returns 64 bits over all fields, names included. Bit patterns count, so 0 and -0 differ. Not collision-resistant
/// against deliberate attacks.
[[nodiscard]] std::uint64_t scene_hash(const Scene& scene);

}  // namespace lobelia
