// Resolves camera rays to visible surfaces.
#include "trace/camera_view.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "trace/wave.h"

namespace lobelia {
namespace {

/// Maximum number of transparent surfaces to step through; the path tracer handles the rest.
constexpr int k_most_layers = 64;

}  // namespace

CameraRays::CameraRays(const Camera& camera, std::size_t width, std::size_t height, std::uint32_t seed)
    : origin_(camera.world_from_camera.translation), width_(width), seed_(seed) {
    const float half_height = std::tan(0.5f * camera.vertical_field_of_view);
    const float half_width = half_height * static_cast<float>(width) / static_cast<float>(height);
    const auto world = [&](Vec3 v) { return transform_vector(camera.world_from_camera, v); };
    corner_ = world({-half_width, half_height, -1});
    right_ = world({2 * half_width / static_cast<float>(width), 0, 0});
    down_ = world({0, -2 * half_height / static_cast<float>(height), 0});
}

PathStart CameraRays::ray(std::size_t pixel, std::uint32_t sample) const {
    const auto key = static_cast<std::uint32_t>(pixel);
    const Pair place = pair(key, sample, 0, seed_);
    const float x = static_cast<float>(pixel % width_) + place.a, y = static_cast<float>(pixel / width_) + place.b;
    return {origin_, normalize(corner_ + right_ * x + down_ * y), key, sample};
}

CameraView::CameraView(const PathTracer& tracer, std::vector<std::uint8_t> baked)
    : tracer_(&tracer), baked_(std::move(baked)), surfaces_(tracer.scene(), tracer.world()) {
    const Scene& scene = tracer.scene();
    for (const Material& material : scene.materials) more_than_paths_ |= material.unlit;
    for (const std::uint8_t b : baked_) more_than_paths_ |= b != 0;
}

Rgb CameraView::unlit_color(const PathTracer::Hit& hit) const {
    return surfaces_.base_color(hit.triangle, hit.u, hit.v);
}

CameraView::Meets CameraView::meet(const PathTracer::Hit& hit, std::uint32_t salt, Sight::Kind& kind) const {
    const World& world = tracer_->world();
    const Material& material = tracer_->scene().materials[world.material[hit.triangle]];
    if (hit.back_face && !material.double_sided) return Meets::passes;
    const bool baked = baked_[world.object[hit.triangle]] != 0 && !hit.back_face;
    kind = material.unlit ? Sight::Kind::unlit : baked ? Sight::Kind::baked : Sight::Kind::paths;
    if (material.alpha_mode == Material::Alpha::opaque) return Meets::stops;
    return surfaces_.passes(hit.triangle, hit.u, hit.v, salt) ? Meets::passes : Meets::stops;
}

void CameraView::resolve(std::span<const PathStart> rays, std::span<Sight> out) const {
    assert(out.size() == rays.size());
    std::vector<std::uint32_t> active;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        out[i] = {Sight::Kind::paths, rays[i], {}};
        if (more_than_paths_) active.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<PathTracer::Ray> next;
    std::vector<PathTracer::Hit> hits;
    for (int layer = 0; layer < k_most_layers && !active.empty(); ++layer) {
        // Trace the active rays to their next surface of any material.
        next.clear();
        for (const std::uint32_t i : active)
            next.push_back({out[i].start.origin, out[i].start.direction, std::numeric_limits<float>::infinity()});
        hits.resize(next.size());
        tracer_->closest(next, hits);

        // Keep the rays that pass through it.
        std::size_t kept = 0;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            const std::uint32_t i = active[k];
            if (!std::isfinite(hits[k].distance)) continue;
            Sight::Kind kind{};
            // Use the random number of the path tracer's first ray, so that both decide alike when the path tracer
            // continues.
            const std::uint32_t salt = transparency_salt(mix(rays[i].key, tracer_->options().seed), rays[i].sample, 0);
            const Meets meets = meet(hits[k], salt, kind);
            if (meets == Meets::stops && kind != Sight::Kind::paths) {
                out[i].kind = kind;
                out[i].hit = hits[k];
            } else if (meets == Meets::passes) {
                const Vec3 at = next[k].origin + next[k].direction * hits[k].distance;
                out[i].start.origin = at + next[k].direction * tracer_->lift(at);
                active[kept++] = i;
            }
        }
        active.resize(kept);
    }
}

}  // namespace lobelia
