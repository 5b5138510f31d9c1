// A scene's fingerprint: the same for the same content, on every machine and in every build.
#pragma once

#include <cstdint>

#include "lobelia/scene.h"

namespace lobelia {

/// 64 bits over all fields, names included. Bit patterns count, so 0 and -0 differ. It tells different scenes apart
/// where nobody tries to deceive it.
[[nodiscard]] std::uint64_t scene_hash(const Scene& scene);

}  // namespace lobelia
