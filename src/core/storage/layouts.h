// Layouts that storages have in common: which coefficient goes into which channel of which texture.
#pragma once

#include "lobelia/storage.h"

namespace lobelia::layouts {

/// Formats of one, two and four channels of the same numbers.
struct Widths {
    PixelFormat one, two, four;
};
inline constexpr Widths k_float32{PixelFormat::r32f, PixelFormat::rg32f, PixelFormat::rgba32f};
inline constexpr Widths k_float16{PixelFormat::r16f, PixelFormat::rg16f, PixelFormat::rgba16f};

/// Every coefficient's channels as they are, one after the other.
[[nodiscard]] TextureLayout tight(const CoefficientTraits& traits, const Widths& widths);

/// A colour texture for each coefficient.
[[nodiscard]] TextureLayout one_each(const CoefficientTraits& traits, PixelFormat format);

/// Luma in full, chroma for two by two texels, as halves.
[[nodiscard]] TextureLayout luma_and_chroma(const CoefficientTraits& traits);

/// The leading coefficient as a colour, the others as ratios to it, in bytes or in ten bits. They need lead_bounds.
[[nodiscard]] TextureLayout ratios_of_8_bits(const CoefficientTraits& traits, PixelFormat lead);
[[nodiscard]] TextureLayout ratios_of_10_bits(const CoefficientTraits& traits, PixelFormat lead);

}  // namespace lobelia::layouts
