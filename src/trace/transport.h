// The internals of the path tracer: geometry, surfaces, lights, and the stages of a path.
#pragma once

#include "core/sample/directions.h"
#include "trace/light/light.h"
#include "trace/wave.h"

namespace lobelia {

/// Sobol dimensions, in pairs. Pair 0 is the receiver's own direction (gather.h).
inline constexpr std::uint32_t k_direct_point = 1, k_direct_choice = 2, k_first_surface = 3;
/// Offsets of the pairs used at surface n of a path, from k_first_surface + k_for_each_surface * n.
inline constexpr std::uint32_t k_scatter = 0, k_light_point = 1, k_choice = 2, k_layer = 3, k_for_each_surface = 4;

struct PathTracer::Implementation {
    const Scene* scene;
    const World* world;
    PathOptions options;
    Surfaces surfaces;
    RayScene rays;
    Lights lights;

    Implementation(const Scene& s, const World& w, const PathOptions& o, StopFlag stop);

    /// Traces the first `count` paths of the scratch to their ends.
    void follow(std::span<Incident> out, std::size_t count, Scratch& scratch) const;

  private:
    std::size_t process_hits(std::span<Incident> out, std::size_t count, int depth, Scratch& scratch) const;
    std::size_t extend_paths(std::size_t count, int depth, Scratch& scratch) const;
    void draw(std::size_t count, int depth, Scratch& scratch) const;
    void add_direct_light(std::span<Incident> out, Scratch& scratch) const;
    bool stop(const Path& path, std::uint32_t salt, int depth, RayHit& hit, Incident& out, Scratch& scratch) const;
    void add_emitted(const Path& path, int depth, const SkyLight& light, Incident& out) const;
    void add_surface_emission(const Path& path, int depth, const RayHit& hit, Incident& out) const;
    bool sample_light(const Path& path, const SurfacePoint& at, const Axes& axes, const Draws& draws,
                      ShadowRay& shadow) const;
    bool scatter_on(Path& path, const SurfacePoint& at, const Axes& axes, const Draws& draws) const;
};

}  // namespace lobelia
