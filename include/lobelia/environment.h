// Latitude-longitude environments: directions of texels, samples and exact irradiance, resizing.
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
    /// The inverse of direction(u, v): u = (1 + atan2(x, -z) / pi) / 2 in [0, 1], v = acos(y) / pi.
    struct Position {
        double u = 0, v = 0;
    };
    [[nodiscard]] static Position position(Vec3 direction);
    /// Returns the direction of the centre of texel `index` = y * width + x.
    [[nodiscard]] Vec3 direction(std::size_t index) const;
    /// Returns the index of the texel that contains `direction`.
    [[nodiscard]] std::size_t index(Vec3 direction) const;
    /// Returns the solid angle [sr] of a texel of row y; over all texels they sum to 4 pi.
    [[nodiscard]] double solid_angle(std::size_t y) const;
    /// Returns all texel centres, row by row, in the frame of the domain (see domain_from_world).
    [[nodiscard]] Directions directions(Domain domain = Domain::sphere) const;
    /// Returns the indices of the texels within a domain, in row order: all, or those whose centres are above the
    /// horizon.
    [[nodiscard]] std::vector<std::uint32_t> texels_of(Domain domain) const;
    /// Returns all solid angles, row by row.
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

/// Rotates the world to the frame of a domain. The sphere uses the world's axes, y up; the hemisphere is the tangent
/// frame of a horizontal surface, whose z axis (the normal) is the world's y: (x, y, z) becomes (x, -z, y).
[[nodiscard]] Vec3 domain_from_world(Domain domain, Vec3 direction);
[[nodiscard]] Vec3 world_from_domain(Domain domain, Vec3 direction);

/// Resamples the environment to `target` by exact overlap of texels in solid angle: preserves the integral over any set
/// of whole target texels (to rounding), and so the energy. The target's texels tile the circle of longitudes, so the
/// seam at u = 0 needs no special case. Precondition: both sizes at least 1 x 1.
[[nodiscard]] Image resize(const Image& environment, LatLong target);

/// Returns the largest grid of the same aspect with at most `most_texels` texels, reduced by a whole number or by as
/// little as possible; the grid itself if it is small enough.
[[nodiscard]] LatLong reduced_grid(LatLong grid, std::size_t most_texels);

/// Returns every texel once, in row order, weighted by its solid angle, in the frame of the domain; the hemisphere has
/// only those above the horizon.
[[nodiscard]] Samples texel_samples(const Image& environment, Domain domain = Domain::sphere);

/// Returns the same texels in a random order whose every prefix is spread evenly over them: along a Hilbert curve
/// through the image, visited in the order of a scrambled van der Corput sequence.
[[nodiscard]] Samples shuffled_texel_samples(const Image& environment, Domain domain, std::uint32_t seed);

/// Returns a sample for each direction (in the domain's frame): the value of the nearest texel, and an equal share of
/// the domain.
[[nodiscard]] Samples directed_samples(const Image& environment, DirectionView directions, Domain domain);

/// Returns the pixels as colours, row by row.
[[nodiscard]] Colours radiance_of(const Image& image);

/// Returns the mean radiance over the sphere, each texel weighted by its solid angle.
[[nodiscard]] Rgb mean_radiance(const Image& environment);

/// Computes the exact irradiance E(n) = sum_j L_j omega_j max(0, n . d_j) [W/m^2] of `samples` at each normal.
void irradiance_sum(SampleView samples, DirectionView normals, MutableColourView out);
/// Computes E(-n) as well, into `opposite`; faster than two calls.
void irradiance_sums(SampleView samples, DirectionView normals, MutableColourView out, MutableColourView opposite);

}  // namespace lobelia
