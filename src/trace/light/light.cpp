// Sampling a light source, and a point on it.
#include "trace/light/light.h"

#include <cassert>
#include <limits>

#include "core/sample/directions.h"
#include "scene/light/light_kind.h"

namespace lobelia {
namespace {

/// Maps a point uniformly to the spherical cap about z whose rim has cosine 1 - flatness; accurate for the smallest
/// discs.
Vec3 cap_direction(float flatness, Pair point) {
    const float h = flatness * point.a, r = std::sqrt(h * (2 - h));
    const auto [c, s] = cos_sin_turns(point.b);
    return {r * c, r * s, 1 - h};
}

bool in_cap(Vec3 axis, float flatness, Vec3 direction) {
    const Vec3 d = direction - axis;
    return dot(d, d) <= 2 * flatness;
}

/// Returns KHR_lights_punctual's window, which attenuates light to 0 at `range`.
float range_window(float distance2, float range) {
    if (range <= 0) return 1;
    const float q = distance2 / (range * range);
    return std::clamp(1 - q * q, 0.0f, 1.0f);
}

}  // namespace

SkyLight Lights::sky(const GroupWeights& weights, float total, const EnvironmentSample& environment) const {
    SkyLight light{environment.radiance, 0};
    const auto probability = [&](const LightSource& s) { return total > 0 ? s.share * weights[s.group] / total : 0; };
    if (environment_ && sample_lights_) light.pdf = probability(sources_[0]) * environment.pdf;
    for (const Sun& sun : suns_)
        if (sun.flatness > 0 && in_cap(sun.axes.z, sun.flatness, environment.direction)) {
            light.radiance = light.radiance + sun.radiance;
            if (sample_lights_) light.pdf += probability(sources_[sun.source]) * sun.disc_pdf;
        }
    return light;
}

SkyLight Lights::sky(const Vantage& at, Vec3 direction) const {
    if (!environment_ && suns_.empty()) return {};
    GroupWeights weights;
    const float total = weights_.weigh(at, weights);
    return sky(weights, total, environment_ ? environment_->at(direction) : EnvironmentSample{direction, {}, 0});
}

float Lights::triangle_pdf(const Vantage& at, std::uint32_t emitter, float distance, float cosine) const {
    if (!sample_lights_) return 0;
    GroupWeights weights;
    const float total = weights_.weigh(at, weights);
    const LightSource& s = sources_[source_of_emitter_[emitter]];
    return total > 0 ? s.share * weights[s.group] / total * distance * distance / (s.area * cosine) : 0;
}

LightSample Lights::sample_triangle(const LightSource& source, float probability, const Vantage& at, Pair point) const {
    // Choose a point uniformly by area (folding the square along its diagonal would break strata; the root does not).
    const std::uint32_t triangle = surfaces_->emissive()[source.index];
    const Facet& f = surfaces_->facet(triangle);
    const float root = std::sqrt(point.a), u = root * (1 - point.b), v = root * point.b;
    const Vec3 to = f.corner + f.edge_u * u + f.edge_v * v - at.position;
    const float side = dot(f.normal, to);
    if (side == 0 || (side > 0 && !surfaces_->double_sided(triangle))) return {};

    // End the shadow ray a little before the triangle, so that it does not hit the emitter itself.
    const Vec3 aim = to + f.normal * (side > 0 ? -f.lift : f.lift);
    const float distance2 = dot(to, to), distance = std::sqrt(distance2);
    const float pdf = probability * distance2 * distance / (source.area * std::abs(side));
    const float reach = length(aim);
    const Rgb radiance = surfaces_->emission(triangle, u, v) * surfaces_->opacity(triangle, u, v);
    return {aim * (1 / reach), reach, radiance * (1 / pdf), pdf};
}

LightSample Lights::sample_punctual(const PunctualLight& light, float probability, const Vantage& at) const {
    const Vec3 to = light.position - at.position;
    const float distance2 = dot(to, to), distance = std::sqrt(distance2);
    if (distance2 < std::numeric_limits<float>::min()) return {};
    const Vec3 direction = to * (1 / distance);
    float factor = range_window(distance2, light.range) / (distance2 * probability);
    if (const auto profile = light_kind(light.kind).profile; profile != nullptr)
        factor *= profile(light, -dot(direction, light.direction));
    return {direction, distance, light.intensity * factor, 0};
}

LightSample Lights::sample_sky(const LightSource& source, const GroupWeights& weights, float total, const Vantage& at,
                               Pair point) const {
    EnvironmentSample environment;
    if (source.kind == Kind::environment) {
        const EnvironmentLight::Drawn drawn = environment_->draw(point);
        if (dot(at.normal, drawn.direction) < 0) return {};
        environment = environment_->evaluate(drawn);
    } else {
        const Sun& sun = suns_[source.index];
        if (sun.flatness == 0) {
            const float probability = source.share * weights[source.group] / total;
            return {sun.axes.z, k_infinite, sun.irradiance * (1 / probability), 0};
        }
        environment.direction = sun.axes.world(cap_direction(sun.flatness, point));
        if (environment_) environment = environment_->at(environment.direction);
    }
    const SkyLight light = sky(weights, total, environment);
    if (!(light.pdf > 0)) return {};
    return {environment.direction, k_infinite, light.radiance * (1 / light.pdf), light.pdf};
}

LightSample Lights::sample(const Vantage& at, float choice, Pair point) const {
    if (!sample_lights_ || groups_.empty()) return {};

    // Choose a group by its weight; reuse the remainder of the random number to choose within it.
    GroupWeights weights;
    const float total = weights_.weigh(at, weights);
    if (!(total > 0)) return {};
    float rest = choice * total;
    std::size_t g = 0;
    while (g + 1 < groups_.size() && rest >= weights[g]) rest -= weights[g++];
    while (weights[g] == 0)
        --g;  // rounding may step past the last group with a weight; a positive total guarantees one
    const LightGroup& group = groups_[g];
    std::uint32_t chosen = group.first;
    if (group.table) {
        const double left = std::clamp(static_cast<double>(rest / weights[g]), 0.0, 1 - 0x1p-53);
        chosen += static_cast<std::uint32_t>(group.table->sample(left).index);
    }

    // Sample the chosen source.
    const LightSource& source = sources_[chosen];
    if (group.far) return sample_sky(source, weights, total, at, point);
    const float probability = source.share * weights[g] / total;
    if (source.kind == Kind::triangle) return sample_triangle(source, probability, at, point);
    return sample_punctual(scene_->lights[source.index], probability, at);
}

}  // namespace lobelia
