// Wavefronts: a few hundred paths at the same bounce, compacted after each.
// Laine, Karras and Aila 2013 (wavefronts).
#pragma once

#include <vector>

#include "core/sample/sequence.h"
#include "lobelia/planes.h"
#include "trace/path_tracer.h"
#include "trace/rays.h"

namespace lobelia {

/// Paths traced together: enough to amortise loops, few enough for the second-level cache.
inline constexpr std::size_t k_wave = 1024;

/// A path between two surfaces.
struct Path {
    Vec3 origin, direction;
    Vec3 normal;     ///< shading normal of the surface that it left, as passed to light sampling; 0: all directions
    Rgb throughput;  ///< product of BRDF times cosine over pdf
    float pdf = 0;   ///< density of the direction [1/sr]
    std::uint32_t out = 0;  ///< index of the start
};

/// Random numbers of a path at one surface.
struct Draws {
    Pair scatter, light;
    float light_choice = 0, roulette = 0, layer = 0;
};

/// A shadow ray, and the radiance to add if it is unoccluded.
struct ShadowRay {
    Vec3 origin, direction;
    float distance = 0;
    std::uint32_t salt = 0;
    Rgb radiance;
    std::uint32_t out = 0;
};

/// Returns the random number for the transparency of ray `ray` of a path; `mixed_key` is mix(key, seed) of its start.
[[nodiscard]] inline std::uint32_t transparency_salt(std::uint32_t mixed_key, std::uint32_t sample, std::uint32_t ray) {
    return mix(mix(mixed_key, sample), ray);
}

/// Sequence and point of each path: arrays parallel to the paths, for vectorised draws.
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
    /// Draws pair `dimension_pair` for the first `count` paths.
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
