// Gathering: first directions of receivers, their paths and shadow rays, and the samples made of both.
#include "bake/gather/gather.h"

#include <cassert>

#include "bake/place/texels.h"
#include "core/sample/directions.h"
#include "trace/material.h"

namespace lobelia {
namespace {

constexpr auto k_pi_f = static_cast<float>(k_pi);

/// Returns the density [1/sr] of a direction with this cosine to the normal.
float direction_pdf(Domain domain, DirectionChoice choice, float cosine) {
    if (domain == Domain::sphere) return 1 / (4 * k_pi_f);
    constexpr float uniform = 1 / (2 * k_pi_f);
    return choice == DirectionChoice::uniform ? uniform : 0.5f * (uniform + cosine * k_over_pi);
}

/// Samples a direction about z.
Vec3 sample_direction(Domain domain, DirectionChoice choice, Pair point) {
    if (domain == Domain::sphere) return around_z(1 - 2 * point.a, point.b);
    if (choice == DirectionChoice::uniform) return around_z(1 - point.a, point.b);
    if (point.a < 0.5f) return around_z(1 - 2 * point.a, point.b);
    return cosine_direction({2 * point.a - 1, point.b});
}

/// Makes path starts in the directions of the receiver's sequence.
void make_starts(const Receiver& receiver, std::uint32_t first, DirectionChoice choice, std::uint32_t seed,
                 std::span<PathStart> starts) {
    assert(receiver.position_count > 0);
    assert(receiver.domain == Domain::hemisphere || choice == DirectionChoice::uniform);
    const Axes axes(receiver.normal);
    const std::uint32_t mixed_key = mix(receiver.key, seed);
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const auto s = static_cast<std::uint32_t>(first + i);
        const Vec3 local = sample_direction(receiver.domain, choice, pair_of(mixed_key, s, 0));
        starts[i] = {receiver.positions[s % receiver.position_count],
                     receiver.domain == Domain::sphere ? local : axes.world(local), receiver.key, s};
    }
}

/// Index ranges of a receiver's samples: paths, black samples below its horizon, and direct light.
struct Places {
    Samples* samples;
    std::size_t paths, dark, sources;
};

/// Converts the light that arrived at one receiver into samples and an estimate of its irradiance.
class Receiving {
  public:
    Receiving(const Receiver& receiver, const GatherOptions& options, Gathered& gathered, const Places& places)
        : receiver_(receiver),
          choice_(options.directions),
          frame_from_world_(options.frame == Frame::tangent ? tangent_from_world(receiver.normal) : k_world),
          gathered_(gathered),
          places_(places),
          uniform_(static_cast<float>(1 / solid_angle(receiver.domain))) {}

    void add_path(std::size_t i, Vec3 direction, const Incident& in) {
        const float cosine = weight_of(direction), pdf = direction_pdf(receiver_.domain, choice_, cosine);
        Rgb radiance;
        if (in.back_face) {
            ++gathered_.back_faces;
        } else {
            radiance = in.scattered + in.emitted * (pdf / (pdf + in.source_pdf));
        }
        put(places_.paths + i, direction, radiance, uniform_ / pdf);
        gathered_.irradiance = gathered_.irradiance + radiance * (cosine / pdf);
    }

    /// Adds a light source: irradiance E across the beam as radiance E / solid angle. Without light, the sample is
    /// black and lies in direction `otherwise`.
    void add_source(std::size_t i, const DirectLight& light, Vec3 otherwise) {
        const bool none = is_black(light.irradiance);
        const Vec3 direction = none ? otherwise : light.direction;
        const float cosine = weight_of(direction);
        const float other = light.pdf > 0 ? direction_pdf(receiver_.domain, choice_, cosine) : 0;
        const Rgb irradiance = light.irradiance * (light.pdf > 0 ? light.pdf / (light.pdf + other) : 1);
        put(places_.sources + i, direction, irradiance * (uniform_ / k_splat_share), k_splat_share);
        gathered_.irradiance = gathered_.irradiance + irradiance * cosine;
    }

    void add_dark(std::size_t i, Vec3 direction) {
        const Vec3 below = direction - receiver_.normal * (2 * dot(direction, receiver_.normal));
        put(places_.dark + i, below, {}, 1);
    }

  private:
    /// Returns the weight of radiance in the irradiance: the cosine; for probes, such that the sum is pi times the mean
    /// radiance.
    [[nodiscard]] float weight_of(Vec3 direction) const {
        return receiver_.domain == Domain::sphere ? 0.25f : std::max(0.0f, dot(direction, receiver_.normal));
    }
    void put(std::size_t at, Vec3 direction, Rgb radiance, float share) const {
        places_.samples->set(at, {rotate(frame_from_world_, direction), radiance, share});
    }

    static constexpr Rotation k_world{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Receiver& receiver_;
    DirectionChoice choice_;
    Rotation frame_from_world_;
    Gathered& gathered_;
    Places places_;
    float uniform_;  ///< density of uniform directions [1/sr]
};

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

    // Trace paths from all receivers at once, and shadow rays from the same starts.
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const std::span starts = std::span(buffer.starts_).subspan(r * n, n);
        make_starts(receivers[r], samples.first, options.directions, tracer.options().seed, starts);
        const Vec3 normal = receivers[r].domain == Domain::sphere ? Vec3{} : receivers[r].normal;
        std::fill_n(buffer.normals_.begin() + static_cast<std::ptrdiff_t>(r * n), n, normal);
    }
    tracer.trace(buffer.starts_, buffer.normals_, buffer.incident_, scratch);
    tracer.direct(buffer.starts_, buffer.normals_, buffer.direct_, scratch);

    // Turn the incident light into samples.
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const std::size_t first = r * buffer.stride_;
        Receiving receiving(receivers[r], options, buffer.gathered_[r],
                            {&buffer.samples_, first, first + n, first + buffer.directions_});
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 direction = buffer.starts_[r * n + i].direction;
            receiving.add_path(i, direction, buffer.incident_[r * n + i]);
            receiving.add_source(i, buffer.direct_[r * n + i], direction);
            if (dark) receiving.add_dark(i, direction);
        }
        buffer.gathered_[r].irradiance = buffer.gathered_[r].irradiance * (1 / static_cast<float>(n));
    }
}

}  // namespace lobelia
