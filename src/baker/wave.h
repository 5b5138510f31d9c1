// Paths in flight: a few hundred at a time, all at the same bounce, the dead ones closed up after each.
#pragma once

#include <vector>

#include "baker/path_tracer.h"
#include "baker/rays.h"

namespace lobelia {

/// Paths that are followed together.
inline constexpr std::size_t k_wave = 1024;

/// A path on its way to its next surface: one cache line and a bit.
struct Path {
    Vec3 origin, direction;
    Vec3 normal;     ///< of the surface that it left, or (0, 0, 0): where the light sources were chosen for
    Rgb throughput;  ///< reflectances times cosines over pdfs, so far
    float pdf = 0;   ///< of the direction [1/sr]
    std::uint32_t mixed_key = 0, sample = 0;
    std::uint32_t out = 0;  ///< which start
};

/// A ray towards a light source, and what arrives if nothing stands between.
struct ShadowRay {
    Vec3 origin, direction;
    float distance = 0;
    std::uint32_t salt = 0;
    Rgb radiance;
    std::uint32_t out = 0;
};

class PathTracer::Scratch {
  public:
    std::vector<Path> paths{k_wave};
    std::vector<RayHit> hits{k_wave};
    std::vector<ShadowRay> shadows{k_wave};
    std::uint64_t rays = 0;
};

}  // namespace lobelia
