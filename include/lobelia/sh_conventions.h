// Conventions of other programs for spherical harmonics coefficients: DirectX, Unity, three.js, Filament, glTF.
// docs/conventions.md has the table; signs, scales and orders are data.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "lobelia/math.h"
#include "lobelia/result.h"

namespace lobelia {

/// A program's convention for the coefficient of index l^2 + l + m: theirs = sign scale norm ours. All use the same
/// order.
struct ShConvention {
    enum class Signs { all_plus, condon_shortley };  ///< condon_shortley: (-1)^m
    /// Factor of each degree. radiance: 1. irradiance: A_l. irradiance_over_pi: A_l / pi.
    enum class Scale { radiance, irradiance, irradiance_over_pi };
    /// polynomials: 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2; their normalisation factors are part of the
    /// coefficients.
    enum class Functions { orthonormal, polynomials };
    enum class Degrees { up_to, exactly };
    /// Form in files. rows: an array of [r, g, b]. flat: one array of all numbers in that order. channels: an array for
    /// each channel. unity: SphericalHarmonicsL2 and shader constants.
    enum class Form { rows, flat, channels, unity };

    std::string_view name, description;
    Signs signs;
    Scale scale;
    Functions functions;
    Degrees degrees;
    std::size_t degree;  ///< maximum degree, or the only one
    Form form;
    std::string_view key;  ///< name of the coefficients in files
};

[[nodiscard]] std::span<const ShConvention> sh_conventions();
/// Finds a convention by name. Errors: an unknown name; the message suggests the nearest.
[[nodiscard]] Result<const ShConvention*> find_sh_convention(std::string_view name);

/// Returns the factor from our coefficient of this index to theirs.
[[nodiscard]] double sh_factor(const ShConvention& convention, std::size_t index);

/// Converts our coefficients to theirs. Degrees that the convention lacks are dropped; missing ones are 0.
[[nodiscard]] std::vector<Rgb> exported(const ShConvention& convention, std::span<const Rgb> ours);
/// Converts their coefficients to ours: the same number.
[[nodiscard]] std::vector<Rgb> imported(const ShConvention& convention, std::span<const Rgb> theirs);

/// Mirrors one axis (0, 1, 2: x, y, z) of the radiance: converts between right- and left-handed coordinates.
[[nodiscard]] std::vector<Rgb> mirrored(std::span<const Rgb> ours, std::size_t axis);

/// Unity's shader constants, converted from and to its nine coefficients: E / pi = A . (n, 1) + B . (xy, yz, zz, zx) +
/// C (xx - yy).
struct UnityShaderConstants {
    std::array<std::array<float, 4>, 3> A{};  ///< SHAr, SHAg, SHAb
    std::array<std::array<float, 4>, 3> B{};  ///< SHBr, SHBg, SHBb
    std::array<float, 4> C{};                 ///< SHC: r, g, b, 1
};
[[nodiscard]] UnityShaderConstants unity_constants(std::span<const Rgb> nine);
[[nodiscard]] std::vector<Rgb> coefficients_of(const UnityShaderConstants& constants);

}  // namespace lobelia
