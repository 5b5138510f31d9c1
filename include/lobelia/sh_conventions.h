// Coefficients of spherical harmonics as others write them: DirectX, Unity, three.js, Filament, glTF.
// docs/conventions.md has the table; signs, scales and orders are data.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "lobelia/math.h"
#include "lobelia/result.h"

namespace lobelia {

/// How somebody writes the coefficient of index l^2 + l + m: theirs = sign scale norm ours. All order them as we do.
struct ShConvention {
    enum class Signs { all_plus, condon_shortley };  ///< the latter: (-1)^m
    /// Of radiance: 1; of irradiance: A_l; of irradiance over pi: A_l / pi.
    enum class Scale { radiance, irradiance, irradiance_over_pi };
    /// Of orthonormal functions, or of the polynomials 1; y, z, x; xy, yz, 3z^2 - 1, xz, x^2 - y^2, whose factors in
    /// the orthonormal ones are part of the coefficients then.
    enum class Functions { orthonormal, polynomials };
    enum class Degrees { up_to, exactly };
    /// How files have them: an array of [r, g, b]; of all numbers in that order; an array for each channel; or
    /// Unity's, SphericalHarmonicsL2 and shader constants.
    enum class Form { rows, flat, channels, unity };

    std::string_view name, description;
    Signs signs;
    Scale scale;
    Functions functions;
    Degrees degrees;
    std::size_t degree;  ///< the largest, or the only one
    Form form;
    std::string_view key;  ///< what files call them
};

[[nodiscard]] std::span<const ShConvention> sh_conventions();
/// By name; the error of an unknown one lists the nearest.
[[nodiscard]] Result<const ShConvention*> find_sh_convention(std::string_view name);

/// What our coefficient of this index is multiplied by to be theirs.
[[nodiscard]] double sh_factor(const ShConvention& convention, std::size_t index);

/// Ours as theirs. Degrees that they do not have are left out, and what they have more is 0.
[[nodiscard]] std::vector<Rgb> exported(const ShConvention& convention, std::span<const Rgb> ours);
/// Theirs as ours: as many.
[[nodiscard]] std::vector<Rgb> imported(const ShConvention& convention, std::span<const Rgb> theirs);

/// Coefficients of L'(x, y, z) = L with one axis (0, 1, 2: x, y, z) turned round: between right- and left-handed
/// worlds.
[[nodiscard]] std::vector<Rgb> mirrored(std::span<const Rgb> ours, std::size_t axis);

/// Unity's shader constants, from and to its nine coefficients: E / pi = A . (n, 1) + B . (xy, yz, zz, zx) + C (xx -
/// yy).
struct UnityShaderConstants {
    std::array<std::array<float, 4>, 3> A{};  ///< SHAr, SHAg, SHAb
    std::array<std::array<float, 4>, 3> B{};  ///< SHBr, SHBg, SHBb
    std::array<float, 4> C{};                 ///< SHC: r, g, b, 1
};
[[nodiscard]] UnityShaderConstants unity_constants(std::span<const Rgb> nine);
[[nodiscard]] std::vector<Rgb> coefficients_of(const UnityShaderConstants& constants);

}  // namespace lobelia
