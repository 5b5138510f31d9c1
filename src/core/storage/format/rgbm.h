// RGBM: a colour in [0, 1] as a byte for each channel times a common factor of a byte.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lobelia/math.h"

namespace lobelia::texels {

/// A component is its byte times the factor's byte over 255^2. The factor is the least that reaches the largest
/// component, so that the components use their bytes as well as they can. Red is lowest, the factor highest.
[[nodiscard]] inline std::uint32_t rgbm_from(Rgb c) {
    const auto cut = [](float v) { return std::min(std::max(v, 0.0f), 1.0f); };
    const float r = cut(c.r), g = cut(c.g), b = cut(c.b);
    const float factor = std::max(std::ceil(std::max({r, g, b}) * 255.0f), 1.0f);
    const float steps = 65025.0f / factor;
    const auto rounded = [&](float v) { return static_cast<std::uint32_t>(std::min(v * steps + 0.5f, 255.0f)); };
    return rounded(r) | rounded(g) << 8 | rounded(b) << 16 | static_cast<std::uint32_t>(factor) << 24;
}

[[nodiscard]] inline Rgb rgb_from_rgbm(std::uint32_t packed) {
    const float step = static_cast<float>(packed >> 24) / 65025.0f;
    return {static_cast<float>(packed & 255) * step, static_cast<float>(packed >> 8 & 255) * step,
            static_cast<float>(packed >> 16 & 255) * step};
}

}  // namespace lobelia::texels
