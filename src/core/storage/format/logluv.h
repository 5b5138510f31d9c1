// LogLuv: the logarithm of the luminance in 15 bits, and the chromaticity (u', v') in a byte each. Ward Larson 1998.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/math/colour.h"

namespace lobelia::texels {

/// Steps of u' and v', which all visible colours keep below 0.62; steps of log2 Y, which begins at -64.
inline constexpr float k_chroma_steps = 410, k_log_steps = 256, k_least_log = -64;
/// Luminances that have a code other than black.
inline constexpr float k_least_luminance = 0x1p-63f, k_largest_luminance = 0x1p63f;

/// v' is lowest, then u', then 15 bits of luminance; the upper bit, that of negative luminance, is 0. Components below
/// 0 are cut.
[[nodiscard]] inline std::uint32_t logluv_from(Rgb c) {
    const auto cut = [](float v) { return std::max(v, 0.0f); };
    const float r = cut(c.r), g = cut(c.g), b = cut(c.b);
    const float X = 0.41239080f * r + 0.35758434f * g + 0.18048079f * b;
    const float Y = 0.21263901f * r + 0.71516868f * g + 0.07219232f * b;
    const float Z = 0.01933082f * r + 0.11919478f * g + 0.95053215f * b;
    if (!(Y >= k_least_luminance)) return 0;
    const float log = (std::log2(std::min(Y, k_largest_luminance)) - k_least_log) * k_log_steps;
    const float sum = X + 15.0f * Y + 3.0f * Z;
    const auto part = [&](float numerator) { return static_cast<std::uint32_t>(numerator * k_chroma_steps / sum); };
    return static_cast<std::uint32_t>(log) << 16 | part(4.0f * X) << 8 | part(9.0f * Y);
}

/// Every part is read as the middle of its step. Components that fall below 0, outside the gamut, become 0.
[[nodiscard]] inline Rgb rgb_from_logluv(std::uint32_t packed) {
    const std::uint32_t log = packed >> 16 & 0x7fff;
    if (log == 0) return {};
    const float Y = std::exp2((static_cast<float>(log) + 0.5f) / k_log_steps + k_least_log);
    const float u = (static_cast<float>(packed >> 8 & 255) + 0.5f) / k_chroma_steps;
    const float v = (static_cast<float>(packed & 255) + 0.5f) / k_chroma_steps;
    const float scale = Y / (4.0f * v);
    const Rgb c = rgb_from({9.0f * u * scale, Y, (12.0f - 3.0f * u - 20.0f * v) * scale});
    return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

}  // namespace lobelia::texels
