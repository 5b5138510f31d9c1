// Wavefront path tracing, bounce by bounce, with next event estimation at every surface.
// Kajiya 1986; Arvo and Kirk 1990 (Russian roulette); Veach 1997 (balance heuristic).
#include "trace/transport.h"

#include <cassert>

namespace lobelia {
namespace {

/// Relative distance within which a front face coincides with the back face that was hit.
constexpr float k_same_spot = 1e-5f;

}  // namespace

PathTracer::Implementation::Implementation(const Scene& s, const World& w, const PathOptions& o, StopFlag stop)
    : scene(&s),
      world(&w),
      options(o),
      surfaces(s, w),
      rays(w, surfaces.kinds(), surfaces, stop),
      lights(s, surfaces, o) {
    assert(o.bounces >= 0);
}

/// Resolves a hit to the first surface that blocks light; returns false if there is none. Receivers must not see back
/// faces: the first is reported in `out`, and light found beyond it is for pictures only.
bool PathTracer::Implementation::stop(const Path& path, std::uint32_t salt, int depth, RayHit& hit, Incident& out,
                                      Scratch& scratch) const {
    if (hit.distance == k_infinite) return false;
    const auto shows_back = [&] {
        return (rays.kind(hit.triangle) & k_one_sided) != 0 &&
               dot(surfaces.facet(hit.triangle).normal, path.direction) > 0;
    };
    const auto trace_again = [&](Backs backs) {
        hit = rays.closest_stop(path.origin, path.direction, salt, backs);
        ++scratch.rays;
        return hit.distance != k_infinite;
    };
    if (rays.kind(hit.triangle) == 0) return true;
    const bool clear =
        (rays.kind(hit.triangle) & k_transparent) != 0 && surfaces.passes(hit.triangle, hit.u, hit.v, salt);
    if (!clear && !shows_back()) return true;
    if (depth > 0) return trace_again(Backs::pass);

    if (clear && !trace_again(Backs::stop)) return false;
    if (!shows_back()) return true;
    const float first = hit.distance;
    const bool stopped = trace_again(Backs::pass);
    if (hit.distance > first * (1 + k_same_spot)) {
        out.back_face = true;
        out.distance = first;
    }
    return stopped;
}

/// Adds the emission that a path hit, with the MIS weight against light sampling (balance heuristic).
void PathTracer::Implementation::add_emitted(const Path& path, int depth, const SkyLight& light, Incident& out) const {
    if (depth == 0) {
        out.emitted = light.radiance;
        out.source_pdf = light.pdf;
    } else {
        const float weight = path.pdf / (path.pdf + light.pdf);
        out.scattered = out.scattered + product(path.throughput, light.radiance) * weight;
    }
}

void PathTracer::Implementation::add_surface_emission(const Path& path, int depth, const RayHit& hit,
                                                      Incident& out) const {
    const Facet& f = surfaces.facet(hit.triangle);
    if (f.emitter == k_no_emitter) return;
    const float cosine = std::abs(dot(f.normal, path.direction));
    const Vantage from{path.origin, path.normal};
    const float pdf = cosine > 0 ? lights.triangle_pdf(from, f.emitter, hit.distance, cosine) : 0;
    add_emitted(path, depth, {surfaces.emission(hit.triangle, hit.u, hit.v), pdf}, out);
}

/// Samples a light source and fills the shadow ray; returns false if no light can arrive.
bool PathTracer::Implementation::sample_light(const Path& path, const SurfacePoint& at, const Axes& axes,
                                              const Draws& draws, ShadowRay& shadow) const {
    const LightSample light = lights.sample({at.origin, at.normal}, draws.light_choice, draws.light);
    if (is_black(light.irradiance) || dot(light.direction, at.face) <= 0) return false;
    const Vec3 wo = axes.local(path.direction * -1.0f), wi = axes.local(light.direction);
    const auto [reflection, pdf] = reflect(at.reflectance, wo, wi);
    if (is_black(reflection)) return false;
    const float weight = light.pdf > 0 ? light.pdf / (light.pdf + pdf) : 1;
    shadow.origin = at.origin;
    shadow.direction = light.direction;
    shadow.distance = light.distance;
    shadow.radiance = product(path.throughput, product(reflection, light.irradiance)) * weight;
    shadow.out = path.out;
    return true;
}

/// Samples the continuation ray; returns false if the path ends.
bool PathTracer::Implementation::scatter_on(Path& path, const SurfacePoint& at, const Axes& axes,
                                            const Draws& draws) const {
    const Scattered s = scatter(at.reflectance, axes.local(path.direction * -1.0f), draws.scatter, draws.layer);
    if (!(s.pdf > 0)) return false;
    const Vec3 direction = axes.world(s.wi);
    if (dot(direction, at.face) <= 0) return false;
    path.throughput = product(path.throughput, s.weight);
    const float strength = largest(path.throughput);
    if (!(strength > 0)) return false;

    // Russian roulette: end weak paths at random, and scale the survivors up.
    if (options.roulette == Switch::on && strength < 1) {
        if (draws.roulette >= strength) return false;
        path.throughput = path.throughput * (1 / strength);
    }
    path.origin = at.origin;
    path.direction = direction;
    path.normal = at.normal;
    path.pdf = s.pdf;
    return true;
}

void PathTracer::Implementation::draw(std::size_t count, int depth, Scratch& scratch) const {
    const std::uint32_t first = k_first_surface + k_for_each_surface * static_cast<std::uint32_t>(depth);
    scratch.counters.draw(count, first + k_scatter, scratch.scatter);
    scratch.counters.draw(count, first + k_light_point, scratch.light);
    scratch.counters.draw(count, first + k_choice, scratch.choice);
    if (surfaces.layered()) scratch.counters.draw(count, first + k_layer, scratch.layer);
}

/// Processes hits: resolves transparency, adds emission, and moves the paths that hit a surface to the front of the
/// scratch. Returns their number.
std::size_t PathTracer::Implementation::process_hits(std::span<Incident> out, std::size_t count, int depth,
                                                     Scratch& scratch) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Path& path = scratch.paths[i];
        RayHit hit = scratch.hits[i];
        Incident& result = out[path.out];
        const std::uint32_t salt = scratch.counters.salt(i, 2 * static_cast<std::uint32_t>(depth));
        const bool stopped = stop(path, salt, depth, hit, result, scratch);
        if (depth == 0 && !result.back_face) result.distance = hit.distance;
        if (!stopped) {
            add_emitted(path, depth, lights.sky({path.origin, path.normal}, path.direction), result);
            continue;
        }
        add_surface_emission(path, depth, hit, result);
        if (depth == options.bounces) continue;
        scratch.paths[kept] = path;
        scratch.hits[kept] = hit;
        scratch.counters.move(i, kept++);
    }
    return kept;
}

/// Generates a shadow ray and a continuation ray at every surface; returns the number of surviving paths, at the front.
std::size_t PathTracer::Implementation::extend_paths(std::size_t count, int depth, Scratch& scratch) const {
    std::size_t alive = 0;
    for (std::size_t i = 0; i < count; ++i) {
        Path path = scratch.paths[i];
        const RayHit& hit = scratch.hits[i];
        const SurfacePoint at = surfaces.point(hit.triangle, hit.u, hit.v, path.direction);
        const Axes axes(at.normal);
        const Draws draws{scratch.scatter[i], scratch.light[i], scratch.choice.a[i], scratch.choice.b[i],
                          scratch.layer.a[i]};
        ShadowRay& shadow = scratch.shadows[scratch.shadow_count];
        if (sample_light(path, at, axes, draws, shadow)) {
            shadow.salt = scratch.counters.salt(i, 2 * static_cast<std::uint32_t>(depth) + 1);
            ++scratch.shadow_count;
        }
        if (!scatter_on(path, at, axes, draws)) continue;
        scratch.paths[alive] = path;
        scratch.counters.move(i, alive++);
    }
    return alive;
}

/// Traces the shadow rays, and adds the light of the unoccluded ones.
void PathTracer::Implementation::add_direct_light(std::span<Incident> out, Scratch& scratch) const {
    for (std::size_t i = 0; i < scratch.shadow_count; ++i) {
        const ShadowRay& s = scratch.shadows[i];
        if (!rays.stopped(s.origin, s.direction, s.distance, s.salt, Backs::pass))
            out[s.out].scattered = out[s.out].scattered + s.radiance;
    }
    scratch.rays += scratch.shadow_count;
    scratch.shadow_count = 0;
}

void PathTracer::Implementation::follow(std::span<Incident> out, std::size_t count, Scratch& scratch) const {
    for (int depth = 0; count > 0; ++depth) {
        for (std::size_t i = 0; i < count; ++i)
            scratch.hits[i] = rays.closest(scratch.paths[i].origin, scratch.paths[i].direction, k_infinite);
        scratch.rays += count;
        count = process_hits(out, count, depth, scratch);
        draw(count, depth, scratch);
        count = extend_paths(count, depth, scratch);
        add_direct_light(out, scratch);
    }
}

}  // namespace lobelia
