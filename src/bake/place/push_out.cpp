// Finds back faces around positions, and moves the positions past them.
#include "bake/place/push_out.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lobelia {
namespace {

using Ray = PathTracer::Ray;
using Hit = PathTracer::Hit;

constexpr float k_infinite = std::numeric_limits<float>::infinity();

/// Rays along the surface: the first search uses few, rotated from position to position; the second uses all.
constexpr std::size_t k_first_look = 4, k_second_look = 8;
/// Reach of the first search, in texel widths: its four rays hit any wall nearer than one width.
constexpr float k_first_reach = 1.5f;
/// Maximum push-out steps; nested objects need several. Points still inside afterwards stay buried.
constexpr int k_most_steps = 3;
/// Texels processed at a time.
constexpr std::size_t k_texels_at_once = 64;

/// Returns a unit tangent vector; `turn` from 0 to 1 rotates it once around the normal.
Vec3 along_surface(Vec3 normal, float turn) {
    const Rotation frame = tangent_from_world(normal);
    const float angle = static_cast<float>(2 * k_pi) * turn;
    return frame[0] * std::cos(angle) + frame[1] * std::sin(angle);
}

class Pusher {
  public:
    explicit Pusher(const PathTracer& tracer) : tracer_(tracer) {}

    void run(std::span<const TexelReach> reach, std::span<Receiver> texels);

  private:
    /// Returns whether the ray hit the back of an opaque surface that is lit on its front only.
    [[nodiscard]] bool from_behind(const Hit& hit) const;
    /// Collects the texels from which a ray of the first search hits a back face.
    void find_suspects(std::span<const TexelReach> reach, std::span<const Receiver> texels);
    /// Returns the new place of a position, or nothing if it is buried.
    [[nodiscard]] std::optional<Vec3> moved(Vec3 position, Vec3 normal, float width) const;
    [[nodiscard]] bool sees_only_backs(Vec3 position, Vec3 normal) const;
    /// Returns a point just past a back-face hit, or nothing if another surface blocks light there.
    [[nodiscard]] std::optional<Vec3> past(const Ray& ray, const Hit& hit) const;

    const PathTracer& tracer_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<std::size_t> texel_of_ray_, suspects_;
};

bool Pusher::from_behind(const Hit& hit) const {
    if (!std::isfinite(hit.distance) || !hit.back_face) return false;
    const Material& material = tracer_.scene().materials[tracer_.world().material[hit.triangle]];
    return !material.double_sided && material.alpha_mode == Material::Alpha::opaque;
}

void Pusher::find_suspects(std::span<const TexelReach> reach, std::span<const Receiver> texels) {
    rays_.clear();
    texel_of_ray_.clear();
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const auto add = [&](std::size_t k, Vec3 direction, float farthest) {
            rays_.push_back({texels[i].positions[k], direction, farthest});
            texel_of_ray_.push_back(i);
        };
        for (std::size_t k = 0; k < texels[i].position_count; ++k) {
            for (std::size_t r = 0; r < k_first_look; ++r) {
                const float turn = static_cast<float>(r * k_most_positions + k) / (k_first_look * k_most_positions);
                add(k, along_surface(reach[i].normals[k], turn), k_first_reach * reach[i].width);
            }
            // Trace straight up as well; one such ray without limit finds surfaces whose sides are farther than a
            // texel.
            add(k, reach[i].normals[k], k == 0 ? k_infinite : reach[i].width);
        }
    }
    hits_.resize(rays_.size());
    tracer_.closest(rays_, hits_);
    suspects_.clear();
    for (std::size_t r = 0; r < rays_.size(); ++r)
        if (from_behind(hits_[r]) && (suspects_.empty() || suspects_.back() != texel_of_ray_[r]))
            suspects_.push_back(texel_of_ray_[r]);
}

std::optional<Vec3> Pusher::past(const Ray& ray, const Hit& hit) const {
    // Step past the surface by a few ray offsets.
    const float lift = tracer_.lift(ray.origin);
    const float slope = std::max(0.125f, std::abs(dot(ray.direction, tracer_.world().face_normal(hit.triangle))));
    const float step = 4 * lift / slope;
    const Ray beyond{ray.origin + ray.direction * (hit.distance + step / 4), ray.direction, step};
    // If the front of another surface coincides, this is a wall between two rooms.
    if (tracer_.stops({ray.origin, ray.direction, hit.distance + step / 4})) return std::nullopt;
    // Stay in front of the next surface behind it.
    Hit next;
    tracer_.closest({&beyond, 1}, {&next, 1});
    return beyond.origin + beyond.direction * (std::isfinite(next.distance) ? next.distance / 2 : 0.75f * step);
}

bool Pusher::sees_only_backs(Vec3 position, Vec3 normal) const {
    // Trace straight up, and five rays at 60 degrees from the normal.
    std::array<Ray, 6> rays;
    std::array<Hit, 6> hits;
    for (std::size_t r = 0; r < 5; ++r)
        rays[r] = {position, along_surface(normal, static_cast<float>(r) / 5) * std::sqrt(0.75f) + normal * 0.5f,
                   k_infinite};
    rays[5] = {position, normal, k_infinite};
    tracer_.closest(rays, hits);
    const float slack = 4 * tracer_.lift(position);
    for (std::size_t r = 0; r < rays.size(); ++r)
        if (!from_behind(hits[r]) || tracer_.stops({position, rays[r].direction, hits[r].distance + slack}))
            return false;
    return true;
}

std::optional<Vec3> Pusher::moved(Vec3 position, Vec3 normal, float width) const {
    float left = width;
    for (int step = 0; step < k_most_steps; ++step) {
        // Find the nearest back face along the surface, or else above.
        std::array<Ray, k_second_look + 1> rays;
        std::array<Hit, k_second_look + 1> hits;
        for (std::size_t r = 0; r < k_second_look; ++r)
            rays[r] = {position, along_surface(normal, static_cast<float>(r) / k_second_look), left};
        rays[k_second_look] = {position, normal, left};
        tracer_.closest(rays, hits);
        std::optional<Vec3> to;
        float distance = k_infinite;
        for (std::size_t r = 0; r < k_second_look; ++r)
            if (from_behind(hits[r]) && hits[r].distance < distance)
                if (const auto there = past(rays[r], hits[r])) {
                    to = there;
                    distance = hits[r].distance;
                }
        if (!to && from_behind(hits[k_second_look])) {
            to = past(rays[k_second_look], hits[k_second_look]);
            distance = hits[k_second_look].distance;
        }
        if (!to) break;

        // Move there.
        position = *to;
        left = std::max(0.0f, left - distance);
    }
    if (sees_only_backs(position, normal)) return std::nullopt;
    return position;
}

void Pusher::run(std::span<const TexelReach> reach, std::span<Receiver> texels) {
    find_suspects(reach, texels);
    for (const std::size_t i : suspects_) {
        // Keep the positions that are outside; if none are, keep the texel's original ones.
        Receiver result = texels[i];
        result.position_count = 0;
        for (std::size_t k = 0; k < texels[i].position_count; ++k) {
            const auto to = moved(texels[i].positions[k], reach[i].normals[k], reach[i].width);
            result.moved |= !to || !(*to == texels[i].positions[k]);
            if (to) result.positions[result.position_count++] = *to;
        }
        if (result.position_count > 0)
            texels[i] = result;
        else
            texels[i].buried = true;
    }
}

}  // namespace

void push_out(const PathTracer& tracer, std::span<const TexelReach> reach, std::span<Receiver> texels) {
    assert(reach.size() == texels.size());
    Pusher pusher(tracer);
    for (std::size_t begin = 0; begin < texels.size(); begin += k_texels_at_once) {
        const std::size_t count = std::min(k_texels_at_once, texels.size() - begin);
        pusher.run(reach.subspan(begin, count), texels.subspan(begin, count));
    }
}

}  // namespace lobelia
