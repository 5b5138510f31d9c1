// Bases as values, one function per family: spherical_harmonics(2) instead of a name to parse.
#pragma once

#include "lobelia/basis.h"
#include "lobelia/result.h"

namespace lobelia {

/// Real spherical harmonics of degrees 0 to `degree`, 1 to 8: (degree + 1)^2 coefficients ("sh2").
[[nodiscard]] std::shared_ptr<const LinearBasis> spherical_harmonics(std::size_t degree);

/// A spherical Gaussian, exp(sharpness (w . axis - 1)): unit axis, sharpness 0 to 10000; sharpness 0 is the constant
/// function 1 (an ambient lobe).
struct Lobe {
    Vec3 axis{0, 0, 1};
    float sharpness = 0;
    friend bool operator==(const Lobe&, const Lobe&) = default;
};

struct GaussianOptions {
    Domain domain = Domain::sphere;
    std::optional<float> sharpness = {};  ///< 0.01 to 10000, the same for all lobes; absent: derived from their number
    enum class Ambient { none, one } ambient = Ambient::none;  ///< adds a lobe of sharpness 0; on the sphere only
};
/// Makes `count` spherical Gaussians on fixed axes, 1 to 512, spread along a spiral ("sg12", "sg12h", "sg12a",
/// "sg12@5").
[[nodiscard]] std::shared_ptr<const LinearBasis> spherical_gaussians(std::size_t count,
                                                                     const GaussianOptions& options = {});
/// Makes a basis of the given lobes, 1 to 512. Its name contains the lobes: make_basis(name) makes the same basis
/// again.
[[nodiscard]] std::shared_ptr<const LinearBasis> spherical_gaussians(std::vector<Lobe> lobes,
                                                                     Domain domain = Domain::sphere);
/// Returns the lobes of a basis of spherical Gaussians on fixed axes, one for each coefficient; none for other bases.
[[nodiscard]] std::vector<Lobe> lobes_of(const Basis& basis);
/// Parses lobes: lines "x y z sharpness" (the axis is normalised) or "ambient"; # starts a comment. Errors name
/// `source` and the line.
[[nodiscard]] Result<std::vector<Lobe>> parse_lobes(std::string_view text, std::string_view source);

/// `count` spherical Gaussians, 1 to 12, whose axes and sharpness are fitted to the light ("sgfit4").
[[nodiscard]] std::shared_ptr<const FittedBasis> fitted_gaussians(std::size_t count);

/// Constant radiance in each of resolution^2 octahedral cells; even, 2 to 64 ("oct8").
[[nodiscard]] std::shared_ptr<const LinearBasis> octahedral_texels(std::size_t resolution);

/// The H-basis: polynomials orthonormal over the hemisphere, 4 or 6 ("h4").
[[nodiscard]] std::shared_ptr<const LinearBasis> hemisphere_polynomials(std::size_t count);

/// Degree-1 harmonics with zonal degree 2 about one axis for all channels or about each channel's own ("zh3").
enum class ZonalAxis { shared, per_channel };
[[nodiscard]] std::shared_ptr<const FittedBasis> zh3(ZonalAxis axis = ZonalAxis::shared);

/// Squared clamped cosines about the six axes ("ambient-cube").
[[nodiscard]] std::shared_ptr<const LinearBasis> ambient_cube();
/// The ambient dice: values and slopes at the vertices of an icosahedron, Bezier patches between ("dice-bezier").
[[nodiscard]] std::shared_ptr<const LinearBasis> ambient_dice();
/// Ambient light and one directional light ("ahd").
[[nodiscard]] std::shared_ptr<const FittedBasis> ambient_highlight();

}  // namespace lobelia
