// The path tracer's public interface.
#include "trace/path_tracer.h"

#include <cassert>
#include <limits>

#include "trace/transport.h"

namespace lobelia {

PathTracer::PathTracer(const Scene& scene, const World& world, const PathOptions& options, StopFlag stop)
    : implementation_(std::make_unique<const Implementation>(scene, world, options, stop)) {}

PathTracer::~PathTracer() = default;

std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> PathTracer::make_scratch() const {
    return {new Scratch, [](Scratch* scratch) { delete scratch; }};
}

namespace {

/// Calls visit(first, count) for consecutive parts that fit a scratch.
template <class Visit>
void for_each_wave(std::size_t count, const Visit& visit) {
    for (std::size_t first = 0; first < count; first += k_wave) visit(first, std::min(k_wave, count - first));
}

void set_counters(std::span<const PathStart> starts, std::uint32_t seed, Counters& counters) {
    for (std::size_t i = 0; i < starts.size(); ++i) {
        counters.mixed_keys[i] = mix(starts[i].key, seed);
        counters.samples[i] = starts[i].sample;
    }
}

}  // namespace

void PathTracer::trace(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<Incident> out,
                       Scratch& scratch) const {
    assert(out.size() == starts.size() && (normals.empty() || normals.size() == starts.size()));
    for_each_wave(starts.size(), [&](std::size_t first, std::size_t count) {
        set_counters(starts.subspan(first, count), options().seed, scratch.counters);
        for (std::size_t i = 0; i < count; ++i) {
            const PathStart& start = starts[first + i];
            const Vec3 normal = normals.empty() ? Vec3{} : normals[first + i];
            scratch.paths[i] = {start.origin, start.direction, normal, {1, 1, 1}, 0, static_cast<std::uint32_t>(i)};
            out[first + i] = {};
        }
        implementation_->follow(out.subspan(first, count), count, scratch);
    });
}

void PathTracer::direct(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<DirectLight> out,
                        Scratch& scratch) const {
    assert(out.size() == starts.size() && (normals.empty() || normals.size() == starts.size()));
    for_each_wave(starts.size(), [&](std::size_t first, std::size_t count) {
        set_counters(starts.subspan(first, count), options().seed, scratch.counters);
        scratch.counters.draw(count, k_direct_choice, scratch.choice);
        scratch.counters.draw(count, k_direct_point, scratch.light);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 origin = starts[first + i].origin, normal = normals.empty() ? Vec3{} : normals[first + i];
            const LightSample light =
                implementation_->lights.sample({origin, normal}, scratch.choice.a[i], scratch.light[i]);
            out[first + i] = {};
            if (is_black(light.irradiance) || dot(normal, light.direction) < 0) continue;
            ++scratch.rays;
            const std::uint32_t salt = scratch.counters.salt(i, 0xffffffffu);
            if (!implementation_->rays.stopped(origin, light.direction, light.distance, salt, Backs::stop))
                out[first + i] = {light.direction, light.irradiance, light.pdf};
        }
    });
}

void PathTracer::closest(std::span<const Ray> rays, std::span<Hit> out) const {
    assert(out.size() == rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RayHit hit = implementation_->rays.closest(rays[i].origin, rays[i].direction, rays[i].farthest);
        out[i] = {hit.distance, hit.triangle, hit.u, hit.v, false};
        if (hit.distance < std::numeric_limits<float>::infinity())
            out[i].back_face = dot(implementation_->surfaces.facet(hit.triangle).normal, rays[i].direction) > 0;
    }
}

bool PathTracer::stops(const Ray& ray) const {
    return implementation_->rays.stopped(ray.origin, ray.direction, ray.farthest, 0, Backs::pass);
}

bool PathTracer::has_light() const { return implementation_->lights.any(); }
std::uint64_t PathTracer::rays(const Scratch& scratch) { return scratch.rays; }
const World& PathTracer::world() const { return *implementation_->world; }
const Scene& PathTracer::scene() const { return *implementation_->scene; }
const PathOptions& PathTracer::options() const { return implementation_->options; }

float PathTracer::lift(Vec3 p) const {
    const float reach = implementation_->world->radius() / 4;
    return lift_of(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), reach}));
}

}  // namespace lobelia
