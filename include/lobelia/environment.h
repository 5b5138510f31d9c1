// Latitude-longitude environments: which texel looks where, samples and exact irradiance from them, resizing.
#pragma once

#include <cstdint>

#include "lobelia/image.h"
#include "lobelia/sample.h"

namespace lobelia {

/// The mapping of a latitude-longitude grid of `width` x `height` texels; y is the polar axis, docs/conventions.md.
struct LatLong {
    std::size_t width = 0;
    std::size_t height = 0;

    [[nodiscard]] std::size_t size() const { return width * height; }
    /// Direction of the continuous position (u, v) in [0, 1]^2: theta = pi (2u - 1), phi = pi v,
    /// d = (sin phi sin theta, cos phi, -sin phi cos theta).
    [[nodiscard]] static Vec3 direction(double u, double v);
    /// The inverse; u = (1 + atan2(x, -z) / pi) / 2 in [0, 1], v = acos(y) / pi.
    struct Position {
        double u = 0, v = 0;
    };
    [[nodiscard]] static Position position(Vec3 direction);
    /// Direction of the centre of texel `index` = y * width + x.
    [[nodiscard]] Vec3 direction(std::size_t index) const;
    /// Index of the texel that holds `direction`.
    [[nodiscard]] std::size_t index(Vec3 direction) const;
    /// Solid angle [sr] of a texel of row y; over all texels they sum to 4 pi.
    [[nodiscard]] double solid_angle(std::size_t y) const;
    /// All texel centres, row by row, in the frame of the domain (see domain_from_world).
    [[nodiscard]] Directions directions(Domain domain = Domain::sphere) const;
    /// Indices of the texels that a domain sees, in row order: all, or those whose centres are above the horizon.
    [[nodiscard]] std::vector<std::uint32_t> texels_of(Domain domain) const;
    /// All solid angles, row by row.
    [[nodiscard]] std::vector<float> solid_angles() const;

    friend bool operator==(const LatLong&, const LatLong&) = default;
};

/// Checks that a grid has at least one texel.
inline void check_grid(LatLong grid, SourcePlace place = SourcePlace::here()) {
    if (grid.size() == 0) [[unlikely]]
        contract_violated("grid of texels: " + std::to_string(grid.width) + " x " + std::to_string(grid.height) +
                              ", must be at least 1 x 1",
                          place);
}

[[nodiscard]] inline LatLong lat_long(const Image& image) { return {image.width, image.height}; }

/// How a domain sees the world. The sphere has the world's axes, y up; the hemisphere is the tangent frame of a
/// horizontal surface, whose z axis (the normal) is the world's y: (x, y, z) is seen as (x, -z, y).
[[nodiscard]] Vec3 domain_from_world(Domain domain, Vec3 direction);
[[nodiscard]] Vec3 world_from_domain(Domain domain, Vec3 direction);

/// The environment resampled to `target` by exact overlap of texels in solid angle: the integral over any set of whole
/// target texels is kept (to rounding), so energy is, too. The target's texels tile the circle of longitudes, hence the
/// seam at u = 0 needs no special case. Precondition: both sizes at least 1 x 1.
[[nodiscard]] Image resize(const Image& environment, LatLong target);

/// The largest grid of the same aspect with at most `most_texels` texels, by a whole-number or the least possible
/// reduction; the grid itself where it is small enough.
[[nodiscard]] LatLong reduced_grid(LatLong grid, std::size_t most_texels);

/// Every texel once, in row order, weighted by its solid angle, seen by the domain; the hemisphere sees those above the
/// horizon only.
[[nodiscard]] Samples texel_samples(const Image& environment, Domain domain = Domain::sphere);

/// The same texels in a random order of which every beginning is spread evenly over them: along a Hilbert curve
/// through the image, visited in the order of a scrambled van der Corput sequence.
[[nodiscard]] Samples shuffled_texel_samples(const Image& environment, Domain domain, std::uint32_t seed);

/// A sample for each direction (in the domain's frame): the value of the nearest texel, and an equal share of the
/// domain.
[[nodiscard]] Samples directed_samples(const Image& environment, DirectionView directions, Domain domain);

/// The pixels as colours, row by row.
[[nodiscard]] Colours radiance_of(const Image& image);

/// Mean radiance over the sphere, each texel weighted by its solid angle.
[[nodiscard]] Rgb mean_radiance(const Image& environment);

/// Exact irradiance E(n) = sum_j L_j omega_j max(0, n . d_j) [W/m^2] of `samples` at each normal.
void irradiance_sum(SampleView samples, DirectionView normals, MutableColourView out);
/// The same with E(-n) in `opposite`, for less than the two apart.
void irradiance_sums(SampleView samples, DirectionView normals, MutableColourView out, MutableColourView opposite);

}  // namespace lobelia
