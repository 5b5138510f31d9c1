// The largest magnitude of floats.
#pragma once

#include <cstddef>

namespace lobelia::texels {

/// The largest magnitude of `count` values.
[[nodiscard]] float largest_magnitude(const float* values, std::size_t count);

}  // namespace lobelia::texels
