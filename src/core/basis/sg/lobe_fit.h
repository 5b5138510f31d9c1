// The search for lobes that come closest to given light: axes, sharpness and amplitudes. Variable projection (Golub and
// Pereyra 1973), non-negative amplitudes within.
#pragma once

#include <vector>

#include "core/basis/octahedral.h"
#include "core/math/gaussian.h"

namespace lobelia {

struct FittedLobe {
    gaussian::Lobe lobe;
    Rgb amplitude;  ///< >= 0
};

/// Resolution of the octahedral texels that light is given in.
inline constexpr std::size_t k_lobe_fit_resolution = 32;
inline constexpr std::size_t k_most_fitted_lobes = 12;

/// `count` lobes for the light in the texels, in the frame of their map, brightest first; none where all is black.
[[nodiscard]] std::vector<FittedLobe> fit_lobes(std::span<const Rgb> light, std::size_t count);

}  // namespace lobelia
