// Between CIE XYZ, linear Rec. 709 and the sRGB curve, and between lumens and watts.
#pragma once

#include <algorithm>
#include <cmath>

#include "lobelia/math.h"

namespace lobelia {

/// Luminous efficacy of white light over the visible band [lm/W]: Radiance's figure (Ward 1994), by which candela per
/// square metre and W/(m^2 sr) are exchanged everywhere in this project.
inline constexpr double k_white_efficacy = 179;

/// A CIE 1931 XYZ colour; Y in the same unit as the radiance or luminance that it stands for.
struct Xyz {
    double x = 0, y = 0, z = 0;
    friend bool operator==(const Xyz&, const Xyz&) = default;
};

/// A CIE 1931 chromaticity.
struct Chromaticity {
    double x = 0, y = 0;
    friend bool operator==(const Chromaticity&, const Chromaticity&) = default;
};

inline constexpr Chromaticity k_d65{0.3127, 0.3290};
inline constexpr Chromaticity k_equal_energy{1.0 / 3, 1.0 / 3};

/// The colour of chromaticity `c` and luminance `luminance`; c.y must not be 0.
[[nodiscard]] constexpr Xyz xyz_from(Chromaticity c, double luminance) {
    return {c.x / c.y * luminance, luminance, (1 - c.x - c.y) / c.y * luminance};
}

/// Linear Rec. 709 of a colour seen under D65, with Y kept; components are negative outside the gamut. The matrix
/// inverts the primaries (0.64, 0.33), (0.30, 0.60), (0.15, 0.06) with white (0.3127, 0.3290).
[[nodiscard]] constexpr Rgb rgb_from(Xyz c) {
    return {static_cast<float>(3.2409699419 * c.x - 1.5373831776 * c.y - 0.4986107603 * c.z),
            static_cast<float>(-0.9692436363 * c.x + 1.8759675015 * c.y + 0.0415550574 * c.z),
            static_cast<float>(0.0556300797 * c.x - 0.2039769589 * c.y + 1.0569715142 * c.z)};
}

/// The colour that looks under D65 as `c` does under `white`: Bradford's adaptation (Lam 1985), which maps `white` of
/// luminance Y to D65 of luminance Y.
[[nodiscard]] constexpr Xyz adapt_to_d65(Xyz c, Chromaticity white) {
    // Scale the responses of sharpened cones by the ratio of the two whites.
    const auto cones = [](Xyz v) {
        return Xyz{0.8951 * v.x + 0.2664 * v.y - 0.1614 * v.z, -0.7502 * v.x + 1.7135 * v.y + 0.0367 * v.z,
                   0.0389 * v.x - 0.0685 * v.y + 1.0296 * v.z};
    };
    const Xyz from = cones(xyz_from(white, 1)), to = cones(xyz_from(k_d65, 1)), v = cones(c);
    const Xyz s{v.x * to.x / from.x, v.y * to.y / from.y, v.z * to.z / from.z};
    return {0.9869929055 * s.x - 0.1470542564 * s.y + 0.1599626517 * s.z,
            0.4323052697 * s.x + 0.5183602715 * s.y + 0.0492912282 * s.z,
            -0.0085286646 * s.x + 0.0400428217 * s.y + 0.9684866958 * s.z};
}

/// The sRGB curve (IEC 61966-2-1) of a linear value in [0, 1].
[[nodiscard]] inline double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
/// Its inverse.
[[nodiscard]] inline double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Tone curves for values brighter than white: clamp, x / (1 + x), or filmic (Narkowicz 2016, fits ACES). The reports
/// have the same three.
enum class ToneCurve { clamp, reinhard, filmic };

/// The tone of a linear value, in [0, 1]; negative values and NaN become 0.
[[nodiscard]] inline double toned(ToneCurve curve, double linear) {
    const double x = linear > 0 ? std::min(linear, 1e9) : 0;
    switch (curve) {
        case ToneCurve::reinhard:
            return x / (1 + x);
        case ToneCurve::filmic:
            return std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0);
        case ToneCurve::clamp:
            break;
    }
    return std::min(x, 1.0);
}

}  // namespace lobelia
