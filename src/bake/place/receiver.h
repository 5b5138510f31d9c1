// A receiver of light: a texel or a probe.
#pragma once

#include <array>
#include <cstdint>

#include "lobelia/math.h"
#include "lobelia/sample.h"

namespace lobelia {

/// Maximum number of points that a receiver's samples start from: a texel's are spread over its covered part.
inline constexpr std::size_t k_most_positions = 4;

struct Receiver {
    /// Lifted off the surface and pushed out of overlapping geometry; sample s starts at positions[s % position_count].
    std::array<Vec3, k_most_positions> positions{};
    Vec3 normal{0, 0, 1};                ///< unit, smooth; ignored for probes
    std::uint32_t key = 0;               ///< names the receiver in all random sequences
    std::uint8_t position_count = 0;     ///< at least 1
    Domain domain = Domain::hemisphere;  ///< about the normal; sphere: a probe
    bool moved = false;                  ///< a position was pushed out, or dropped because it is buried
    bool buried = false;                 ///< no position could be pushed out: back faces all around
};

}  // namespace lobelia
