// The path tracer: waves of paths, bounce by bounce, with the light sources aimed at from every surface.
#include "baker/path_tracer.h"

#include <cassert>
#include <limits>

#include "baker/directions.h"
#include "baker/light.h"
#include "baker/wave.h"

namespace lobelia {
namespace {

constexpr float k_infinite = std::numeric_limits<float>::infinity();
/// A front this much farther away, relatively, lies on the same spot as the back that was met.
constexpr float k_same_spot = 1e-5f;

/// Sobol dimensions, in pairs. The receiver's own direction is pair 0 (gather.h).
enum Dimension : std::uint32_t {
    k_direct_point = 1,
    k_direct_choice = 2,
    k_first_surface = 3,  // then for each surface:
    k_scatter = 0,
    k_light_point = 1,
    k_light_choice = 2,  // and the roulette
    k_layer_choice = 3,
    k_for_each_surface = 4
};

/// Random numbers of the rays of a path, for transparency: different for each surface and for shadow rays.
std::uint32_t ray_salt(const Path& path, std::uint32_t number) { return mix(mix(path.mixed_key, path.sample), number); }

}  // namespace

struct PathTracer::Implementation {
    const Scene* scene;
    const World* world;
    PathOptions options;
    Surfaces surfaces;
    RayScene rays;
    Lights lights;

    Implementation(const Scene& s, const World& w, const PathOptions& o)
        : scene(&s),
          world(&w),
          options(o),
          surfaces(s, w),
          rays(w, surfaces.kinds(), surfaces),
          lights(s, surfaces, o) {}

    void follow(std::span<Incident> out, std::size_t count, Scratch& scratch) const;
    bool let_through(const Path& path, int depth, RayHit& hit, Incident& out, Scratch& scratch) const;
    void add_emitted(const Path& path, int depth, const SkyLight& light, Incident& out) const;
    void meet_sky(const Path& path, int depth, Incident& out) const;
    void meet_emission(const Path& path, int depth, const RayHit& hit, Incident& out) const;
    bool aim(const Path& path, const SurfacePoint& at, const Axes& axes, int depth, ShadowRay& shadow) const;
    bool scatter_on(Path& path, const SurfacePoint& at, const Axes& axes, int depth) const;
};

/// Finds the surface that stops the path where the first one does not; false where there is no such surface.
bool PathTracer::Implementation::let_through(const Path& path, int depth, RayHit& hit, Incident& out,
                                             Scratch& scratch) const {
    if (hit.distance == k_infinite) return false;
    const std::uint8_t kind = rays.kind(hit.triangle);
    if (kind == 0) return true;
    const bool back = (kind & k_one_sided) != 0 && dot(surfaces.facet(hit.triangle).normal, path.direction) > 0;
    const std::uint32_t salt = ray_salt(path, 2 * static_cast<std::uint32_t>(depth));
    if (!back && ((kind & k_transparent) == 0 || !surfaces.passes(hit.triangle, hit.u, hit.v, salt))) return true;

    const float first = hit.distance;
    hit = rays.closest_stop(path.origin, path.direction, salt);
    ++scratch.rays;
    if (depth == 0 && back && hit.distance > first * (1 + k_same_spot)) {
        out.back_face = true;
        out.distance = first;
    }
    return hit.distance != k_infinite;
}

/// Adds light that the path met by chance, weighted against having been aimed at (balance heuristic).
void PathTracer::Implementation::add_emitted(const Path& path, int depth, const SkyLight& light, Incident& out) const {
    if (depth == 0) {
        out.emitted = light.radiance;
        out.source_pdf = light.pdf;
    } else {
        const float weight = path.pdf / (path.pdf + light.pdf);
        out.scattered = out.scattered + product(path.throughput, light.radiance) * weight;
    }
}

void PathTracer::Implementation::meet_sky(const Path& path, int depth, Incident& out) const {
    add_emitted(path, depth, lights.sky({path.origin, path.normal}, path.direction), out);
}

void PathTracer::Implementation::meet_emission(const Path& path, int depth, const RayHit& hit, Incident& out) const {
    const Facet& f = surfaces.facet(hit.triangle);
    if (f.emitter == k_no_emitter) return;
    const float cosine = std::abs(dot(f.normal, path.direction));
    const float pdf = cosine > 0 ? lights.triangle_pdf({path.origin, path.normal}, f.emitter, hit.distance, cosine) : 0;
    add_emitted(path, depth, {surfaces.emission(hit.triangle, hit.u, hit.v), pdf}, out);
}

/// Aims at one light source; false where nothing can come from it.
bool PathTracer::Implementation::aim(const Path& path, const SurfacePoint& at, const Axes& axes, int depth,
                                     ShadowRay& shadow) const {
    const std::uint32_t first = k_first_surface + k_for_each_surface * static_cast<std::uint32_t>(depth);
    const LightSample light =
        lights.sample({at.origin, at.normal}, pair_of(path.mixed_key, path.sample, first + k_light_choice).a,
                      pair_of(path.mixed_key, path.sample, first + k_light_point));
    if (is_black(light.irradiance) || dot(light.direction, at.face) <= 0) return false;
    const Vec3 wo = axes.local(path.direction * -1.0f), wi = axes.local(light.direction);
    const Rgb reflection = reflected(at.reflectance, wo, wi);
    if (is_black(reflection)) return false;
    const float pdf = light.pdf > 0 ? scatter_pdf(at.reflectance, wo, wi) : 0;
    const float weight = light.pdf > 0 ? light.pdf / (light.pdf + pdf) : 1;
    shadow.origin = at.origin;
    shadow.direction = light.direction;
    shadow.distance = light.distance;
    shadow.salt = ray_salt(path, 2 * static_cast<std::uint32_t>(depth) + 1);
    shadow.radiance = product(path.throughput, product(reflection, light.irradiance)) * weight;
    shadow.out = path.out;
    return true;
}

/// Sends the path on in a new direction; false where it ends.
bool PathTracer::Implementation::scatter_on(Path& path, const SurfacePoint& at, const Axes& axes, int depth) const {
    const std::uint32_t first = k_first_surface + k_for_each_surface * static_cast<std::uint32_t>(depth);
    const float choice = at.reflectance.has_layer ? pair_of(path.mixed_key, path.sample, first + k_layer_choice).a : 0;
    const Scattered s = scatter(at.reflectance, axes.local(path.direction * -1.0f),
                                pair_of(path.mixed_key, path.sample, first + k_scatter), choice);
    if (!(s.pdf > 0)) return false;
    const Vec3 direction = axes.world(s.wi);
    if (dot(direction, at.face) <= 0) return false;
    path.throughput = product(path.throughput, s.weight);
    const float strength = largest(path.throughput);
    if (!(strength > 0)) return false;

    // Russian roulette: weak paths end by chance, the others carry their light.
    if (options.roulette == Switch::on && strength < 1) {
        if (pair_of(path.mixed_key, path.sample, first + k_light_choice).b >= strength) return false;
        path.throughput = path.throughput * (1 / strength);
    }
    path.origin = at.origin;
    path.direction = direction;
    path.normal = at.normal;
    path.pdf = s.pdf;
    return true;
}

/// Follows the first `count` paths of the scratch to their ends.
void PathTracer::Implementation::follow(std::span<Incident> out, std::size_t count, Scratch& scratch) const {
    for (int depth = 0; count > 0; ++depth) {
        // Trace all rays to the first surfaces.
        for (std::size_t i = 0; i < count; ++i)
            scratch.hits[i] = rays.closest(scratch.paths[i].origin, scratch.paths[i].direction, k_infinite);
        scratch.rays += count;

        // Take up emission, aim at light sources, scatter. What is still alive moves to the front.
        std::size_t alive = 0, shadows = 0;
        for (std::size_t i = 0; i < count; ++i) {
            Path path = scratch.paths[i];
            RayHit& hit = scratch.hits[i];
            Incident& result = out[path.out];
            const bool met = let_through(path, depth, hit, result, scratch);
            if (depth == 0 && !result.back_face) result.distance = hit.distance;
            if (!met) {
                meet_sky(path, depth, result);
                continue;
            }
            meet_emission(path, depth, hit, result);
            if (depth == options.bounces) continue;
            const SurfacePoint at = surfaces.point(hit.triangle, hit.u, hit.v, path.direction);
            const Axes axes(at.normal);
            if (aim(path, at, axes, depth, scratch.shadows[shadows])) ++shadows;
            if (scatter_on(path, at, axes, depth)) scratch.paths[alive++] = path;
        }

        // Add the light that is not hidden.
        for (std::size_t i = 0; i < shadows; ++i) {
            const ShadowRay& s = scratch.shadows[i];
            if (!rays.stopped(s.origin, s.direction, s.distance, s.salt))
                out[s.out].scattered = out[s.out].scattered + s.radiance;
        }
        scratch.rays += shadows;
        count = alive;
    }
}

PathTracer::PathTracer(const Scene& scene, const World& world, const PathOptions& options)
    : implementation_(std::make_unique<const Implementation>(scene, world, options)) {}

PathTracer::~PathTracer() = default;

std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> PathTracer::make_scratch() const {
    return {new Scratch, [](Scratch* scratch) { delete scratch; }};
}

void PathTracer::trace(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<Incident> out,
                       Scratch& scratch) const {
    assert(out.size() == starts.size() && (normals.empty() || normals.size() == starts.size()));
    for (std::size_t begin = 0; begin < starts.size(); begin += k_wave) {
        const std::size_t count = std::min(k_wave, starts.size() - begin);
        for (std::size_t i = 0; i < count; ++i) {
            const PathStart& start = starts[begin + i];
            out[begin + i] = {};
            scratch.paths[i] = {start.origin,
                                start.direction,
                                normals.empty() ? Vec3{} : normals[begin + i],
                                {1, 1, 1},
                                0,
                                mix(start.key, implementation_->options.seed),
                                start.sample,
                                static_cast<std::uint32_t>(i)};
        }
        implementation_->follow(out.subspan(begin, count), count, scratch);
    }
}

void PathTracer::direct(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<DirectLight> out,
                        Scratch& scratch) const {
    assert(out.size() == starts.size() && (normals.empty() || normals.size() == starts.size()));
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const PathStart& start = starts[i];
        const std::uint32_t key = mix(start.key, implementation_->options.seed);
        const Vec3 normal = normals.empty() ? Vec3{} : normals[i];
        const LightSample light =
            implementation_->lights.sample({start.origin, normal}, pair_of(key, start.sample, k_direct_choice).a,
                                           pair_of(key, start.sample, k_direct_point));
        out[i] = {};
        if (is_black(light.irradiance) || (normal != Vec3{} && dot(normal, light.direction) <= 0)) continue;
        ++scratch.rays;
        const std::uint32_t salt = mix(mix(key, start.sample), 0xffffffffu);
        if (!implementation_->rays.stopped(start.origin, light.direction, light.distance, salt))
            out[i] = {light.direction, light.irradiance, light.pdf};
    }
}

void PathTracer::closest(std::span<const Ray> rays, std::span<Hit> out) const {
    assert(out.size() == rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RayHit hit = implementation_->rays.closest(rays[i].origin, rays[i].direction, rays[i].farthest);
        out[i] = {hit.distance, hit.triangle, hit.u, hit.v, false};
        if (hit.distance != k_infinite)
            out[i].back_face = dot(implementation_->surfaces.facet(hit.triangle).normal, rays[i].direction) > 0;
    }
}

bool PathTracer::has_light() const { return implementation_->lights.any(); }
std::uint64_t PathTracer::rays(const Scratch& scratch) { return scratch.rays; }
const World& PathTracer::world() const { return *implementation_->world; }
const Scene& PathTracer::scene() const { return *implementation_->scene; }
const PathOptions& PathTracer::options() const { return implementation_->options; }

float PathTracer::lift(Vec3 p) const {
    const World& w = *implementation_->world;
    return lift_of(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), w.radius() / 4}));
}

}  // namespace lobelia
