// Cube maps prefiltered by GGX, for reflection probes.
// Karis 2013 (the split sum); Krivanek and Colbert 2008 (filtered importance sampling).
#pragma once

#include <array>
#include <functional>
#include <string_view>
#include <vector>

#include "core/stop.h"
#include "lobelia/image.h"
#include "lobelia/result.h"

namespace lobelia {

/// How levels and directions of a cube map are to be read. gltf: level = roughness (levels - 1), as
/// EXT_lights_image_based has it. filament: level = roughness (2 - roughness) (levels - 1), as Filament's cmgen writes
/// them. three: as gltf, mirrored along x, for CubeTexture of three.js, which reads (-x, y, z).
enum class CubeConvention { gltf, filament, three };
inline constexpr std::array k_cube_convention_names = {"gltf", "filament", "three"};

/// Returns the roughness of a level; alpha is its square.
[[nodiscard]] double roughness_of_level(CubeConvention convention, std::size_t level, std::size_t levels);

/// Returns the direction of the place (s, t) of [-1, 1]^2 on a face, +x, -x, +y, -y, +z, -z, as graphics interfaces
/// have it: s to the right, t downwards.
[[nodiscard]] Vec3 cube_direction(std::size_t face, double s, double t);

struct PrefilterOptions {
    std::size_t size = 256;  ///< side of a face of the largest level [texels], a power of two
    std::size_t levels = 6;  ///< at most as many as the size can be halved, and itself
    CubeConvention convention = CubeConvention::gltf;
    std::size_t samples = 1024;                 ///< of each texel of each level
    StopFlag stop = {};                         ///< ends the work with an error
    std::function<void(double)> progress = {};  ///< receives the fraction done; never called concurrently
};

/// A level: six faces, one after the other.
struct CubeLevel {
    std::size_t size = 0;
    double roughness = 0;
    std::vector<Rgb> texels;
    /// RMS difference from prefiltered_radiance() over 96 directions, over the RMS of that.
    double error = 0;
};

/// Computes each texel in direction r as the mean of L(l) weighted by D(h) (r.l), h half way between r and l, D the GGX
/// distribution: the reflection for n = v = r. Level 0 is the environment itself. Broad reflections are sums over all
/// texels of the environment, reduced to an eighth of the reflection's width; for narrow ones samples of D read the
/// environment reduced to the solid angle that each stands for.
[[nodiscard]] Result<std::vector<CubeLevel>> prefilter(const Image& environment, const PrefilterOptions& options);

/// The same in one direction, the reference: the sum over all texels of the environment, or `count` samples of them
/// where the reflection is narrower than eight texels.
[[nodiscard]] Rgb prefiltered_radiance(const Image& environment, Vec3 direction, double roughness,
                                       std::size_t count = 65536);

/// The second factor of the split sum, for Schlick's Fresnel factor: reflected light is prefiltered radiance times F0
/// scale + bias. Entry x + size y is (scale, bias) for n.v = (x + 1/2) / size, roughness = (y + 1/2) / size.
[[nodiscard]] std::vector<std::array<float, 2>> split_sum_table(std::size_t size);

}  // namespace lobelia
