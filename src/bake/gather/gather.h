// From receivers (texels, probes) to radiance samples: paths in all directions and shadow rays to light sources,
// combined by multiple importance sampling (Veach 1997, balance heuristic). The samples go straight into an encoder.
#pragma once

#include <span>

#include "bake/place/receiver.h"
#include "lobelia/bake_job.h"
#include "lobelia/sample.h"
#include "trace/path_tracer.h"

namespace lobelia {

struct GatherOptions {
    DirectionChoice directions = DirectionChoice::uniform;
    /// Adds black samples below the horizon, for an encoder over the sphere of receivers that see a hemisphere.
    Switch dark_below = Switch::off;
    /// Frame of the samples' directions; it does not change which paths are traced.
    Frame frame = Frame::world;
};

/// Samples [first, first + count) of every receiver's sequence. Precondition: count is a multiple of k_lanes.
struct SampleRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// Result of one gathering for one receiver, besides its samples.
struct Gathered {
    Rgb irradiance;  ///< estimate of E at the normal (hemisphere) or of the mean radiance times pi (sphere)
    std::uint32_t back_faces = 0;  ///< paths that first met the back of a one-sided surface
};

/// Samples of all receivers, one receiver after another, the same number each, in two parts: path directions, each with
/// a solid angle of 1 if directions are uniform, and otherwise with a mean of 1; and direct light, with a tiny solid
/// angle (k_splat_share) and a radiance such that their product is exact.
class GatherBuffer {
  public:
    [[nodiscard]] SampleView directions(std::size_t receiver) const {
        return samples_.view().part(receiver * stride_, directions_);
    }
    [[nodiscard]] SampleView sources(std::size_t receiver) const {
        return samples_.view().part(receiver * stride_ + directions_, stride_ - directions_);
    }
    [[nodiscard]] const Gathered& gathered(std::size_t receiver) const { return gathered_[receiver]; }

  private:
    friend void gather(const PathTracer&, std::span<const Receiver>, SampleRange, const GatherOptions&, GatherBuffer&,
                       PathTracer::Scratch&);
    Samples samples_;
    std::vector<Gathered> gathered_;
    std::vector<PathStart> starts_;
    std::vector<Incident> incident_;
    std::vector<DirectLight> direct_;
    std::vector<Vec3> normals_;
    std::size_t stride_ = 0;      ///< samples per receiver, a multiple of k_lanes
    std::size_t directions_ = 0;  ///< path directions among them, a multiple of k_lanes
};

inline constexpr float k_splat_share = 1e-6f;

/// Gathers light for all receivers. Reuses the buffer without allocation once it is large enough.
void gather(const PathTracer& tracer, std::span<const Receiver> receivers, SampleRange samples,
            const GatherOptions& options, GatherBuffer& buffer, PathTracer::Scratch& scratch);

}  // namespace lobelia
