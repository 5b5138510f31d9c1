// Gathering: directions for receivers, their paths and light sources, and the samples that come of both.
#include "baker/gather.h"

#include <cassert>

#include "baker/directions.h"
#include "baker/material.h"

namespace lobelia {
namespace {

constexpr auto k_pi_f = static_cast<float>(k_pi);

/// Density [1/sr] of a direction whose cosine to the normal is `cosine`.
float direction_pdf(Domain domain, DirectionChoice choice, float cosine) {
    if (domain == Domain::sphere) return 1 / (4 * k_pi_f);
    constexpr float uniform = 1 / (2 * k_pi_f);
    return choice == DirectionChoice::uniform ? uniform : 0.5f * (uniform + cosine * k_over_pi);
}

/// A direction about z.
Vec3 sample_direction(Domain domain, DirectionChoice choice, Pair point) {
    if (domain == Domain::sphere) return around_z(1 - 2 * point.a, point.b);
    if (choice == DirectionChoice::uniform) return around_z(1 - point.a, point.b);
    if (point.a < 0.5f) return around_z(1 - 2 * point.a, point.b);
    return cosine_direction({2 * point.a - 1, point.b});
}

Vec3 receiver_direction(const Receiver& receiver, DirectionChoice choice, std::uint32_t sample, std::uint32_t seed) {
    const Vec3 local = sample_direction(receiver.domain, choice, pair(receiver.key, sample, 0, seed));
    return receiver.domain == Domain::sphere ? local : Axes(receiver.normal).world(local);
}

}  // namespace

void gather(const PathTracer& tracer, std::span<const Receiver> receivers, SampleRange samples,
            const GatherOptions& options, GatherBuffer& buffer, PathTracer::Scratch& scratch) {
    assert(samples.count % k_lanes == 0);
    const std::size_t n = samples.count, all = n * receivers.size();
    const bool dark = options.dark_below == Switch::on;
    buffer.directions_ = (dark ? 2 : 1) * n;
    buffer.stride_ = buffer.directions_ + n;
    if (buffer.samples_.size() < buffer.stride_ * receivers.size())
        buffer.samples_ = Samples(buffer.stride_ * receivers.size());
    buffer.gathered_.assign(receivers.size(), {});
    buffer.starts_.resize(all);
    buffer.normals_.resize(all);
    buffer.incident_.resize(all);
    buffer.direct_.resize(all);

    // Set out from every receiver in the directions of its sequence.
    const std::uint32_t seed = tracer.options().seed;
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const Receiver& receiver = receivers[r];
        assert(!receiver.positions.empty());
        for (std::size_t i = 0; i < n; ++i) {
            const auto s = static_cast<std::uint32_t>(samples.first + i);
            buffer.starts_[r * n + i] = {receiver.positions[s % receiver.positions.size()],
                                         receiver_direction(receiver, options.directions, s, seed), receiver.key, s};
            buffer.normals_[r * n + i] = receiver.domain == Domain::sphere ? Vec3{} : receiver.normal;
        }
    }
    tracer.trace(buffer.starts_, buffer.normals_, buffer.incident_, scratch);
    tracer.direct(buffer.starts_, buffer.normals_, buffer.direct_, scratch);

    // Turn what arrived into samples.
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const Receiver& receiver = receivers[r];
        const bool sphere = receiver.domain == Domain::sphere;
        const float share = (sphere ? 4 : 2) * k_pi_f;
        const float uniform = 1 / share, splat = uniform / k_splat_share;
        Gathered& gathered = buffer.gathered_[r];
        Rgb sum;
        const auto cosine = [&](Vec3 d) { return sphere ? 0.25f : std::max(0.0f, dot(d, receiver.normal)); };
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 d = buffer.starts_[r * n + i].direction;
            const Incident& in = buffer.incident_[r * n + i];
            const float pdf = direction_pdf(receiver.domain, options.directions, cosine(d));
            Rgb radiance = in.scattered + in.emitted * (pdf / (pdf + in.source_pdf));
            if (in.back_face) {
                radiance = {};
                ++gathered.back_faces;
            }
            const Vec3 out = rotate(receiver.frame_from_world, d);
            const std::size_t first = r * buffer.stride_;
            buffer.samples_.set(first + i, {out, radiance, uniform / pdf});
            sum = sum + radiance * (cosine(d) / pdf);

            const DirectLight& light = buffer.direct_[r * n + i];
            const float light_cosine = cosine(light.direction);
            const float weight =
                light.pdf > 0
                    ? light.pdf / (light.pdf + direction_pdf(receiver.domain, options.directions, light_cosine))
                    : 1;
            const Rgb irradiance = light.irradiance * weight;
            const bool none = is_black(irradiance);
            buffer.samples_.set(
                first + buffer.directions_ + i,
                {none ? out : rotate(receiver.frame_from_world, light.direction), irradiance * splat, k_splat_share});
            sum = sum + irradiance * light_cosine;
            if (dark)
                buffer.samples_.set(
                    first + n + i,
                    {rotate(receiver.frame_from_world, d - receiver.normal * (2 * dot(d, receiver.normal))), {}, 1});
        }
        gathered.irradiance = sum * (1 / static_cast<float>(n));
    }
}

}  // namespace lobelia
