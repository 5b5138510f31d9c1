// Paths in flight: a few hundred at a time, all at the same bounce, the dead ones closed up after each.
// Laine, Karras and Aila 2013 (wavefronts).
#pragma once

#include <vector>

#include "core/sample/sequence.h"
#include "lobelia/planes.h"
#include "trace/path_tracer.h"
#include "trace/rays.h"

namespace lobelia {

/// Paths that are followed together: enough for loops to be worth starting, few enough for the second-level cache.
inline constexpr std::size_t k_wave = 1024;

/// A path on its way to its next surface.
struct Path {
    Vec3 origin, direction;
    Vec3 normal;            ///< of the surface that it left, or (0, 0, 0): where the light sources were chosen for
    Rgb throughput;         ///< reflectances times cosines over pdfs, so far
    float pdf = 0;          ///< of the direction [1/sr]
    std::uint32_t out = 0;  ///< which start
};

/// The random numbers of a path at one surface.
struct Draws {
    Pair scatter, light;
    float light_choice = 0, roulette = 0, layer = 0;
};

/// A ray towards a light source, and what arrives if nothing stands between.
struct ShadowRay {
    Vec3 origin, direction;
    float distance = 0;
    std::uint32_t salt = 0;
    Rgb radiance;
    std::uint32_t out = 0;
};

/// The random number of ray number `ray` of a path, for transparency; `mixed_key` is mix(key, seed) of its start.
[[nodiscard]] inline std::uint32_t transparency_salt(std::uint32_t mixed_key, std::uint32_t sample, std::uint32_t ray) {
    return mix(mix(mixed_key, sample), ray);
}

/// Which point of which sequence each path reads: parallel to the paths, for they are read in vectors.
struct Counters {
    std::vector<std::uint32_t> mixed_keys = std::vector<std::uint32_t>(k_wave);
    std::vector<std::uint32_t> samples = std::vector<std::uint32_t>(k_wave);

    void move(std::size_t from, std::size_t to) {
        mixed_keys[to] = mixed_keys[from];
        samples[to] = samples[from];
    }
    [[nodiscard]] std::uint32_t salt(std::size_t path, std::uint32_t ray) const {
        return transparency_salt(mixed_keys[path], samples[path], ray);
    }
    /// Pair number `dimension_pair` of the first `count`.
    void draw(std::size_t count, std::uint32_t dimension_pair, Pairs& out) const {
        const std::size_t whole = round_up_to_lanes(count);
        pairs_of(std::span(mixed_keys).first(whole), std::span(samples).first(whole), dimension_pair, out);
    }
};

class PathTracer::Scratch {
  public:
    std::vector<Path> paths = std::vector<Path>(k_wave);
    std::vector<RayHit> hits = std::vector<RayHit>(k_wave);
    std::vector<ShadowRay> shadows = std::vector<ShadowRay>(k_wave);
    std::size_t shadow_count = 0;
    Counters counters;
    Pairs scatter{k_wave}, light{k_wave}, choice{k_wave}, layer{k_wave};
    std::uint64_t rays = 0;
};

}  // namespace lobelia
