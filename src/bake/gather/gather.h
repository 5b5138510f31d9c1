// From receivers (texels, probes) to radiance samples: paths in all directions, and the light sources aimed at, joined
// by multiple importance sampling (Veach 1997, balance heuristic). What comes out goes straight into an encoder.
#pragma once

#include <span>

#include "lobelia/sample.h"
#include "trace/path_tracer.h"

namespace lobelia {

/// uniform: over the receiver's domain, best for the moments of radiance. mixture: half uniform, half by the cosine to
/// the normal (hemisphere only), where irradiance at the normal matters most.
enum class DirectionChoice { uniform, mixture };

/// Something that receives light.
struct Receiver {
    std::span<const Vec3> positions;  ///< at least one, lifted off the surface; sample s starts at positions[s % size]
    Vec3 normal;                      ///< unit; of the surface where the domain is the hemisphere
    Domain domain = Domain::hemisphere;  ///< sphere: a probe; its normal means nothing
    /// Frame of the directions that come out. It does not change which paths are followed.
    Rotation frame_from_world{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::uint32_t key = 0;
};

struct GatherOptions {
    DirectionChoice directions = DirectionChoice::uniform;
    /// The encoder's domain is the sphere although the receiver sees a hemisphere: below its horizon nothing arrives,
    /// and samples that say so are added.
    Switch dark_below = Switch::off;
};

/// Samples [first, first + count) of every receiver's sequence; count is a multiple of k_lanes.
struct SampleRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// What one receiver got in one gathering, beside its samples.
struct Gathered {
    Rgb irradiance;  ///< estimate of E at the normal (hemisphere) or of the mean radiance times pi (sphere)
    std::uint32_t back_faces = 0;  ///< paths that first met the back of a one-sided surface
};

/// Samples of all receivers, one after another, the same number each, in two parts: directions seen, each with a solid
/// angle of 1 where directions are uniform, and in general so that the mean over many is 1; and light sources aimed at,
/// with a solid angle of next to nothing (k_splat_share) and a radiance such that their product is exact.
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
    std::size_t stride_ = 0;      ///< samples of a receiver, a multiple of k_lanes
    std::size_t directions_ = 0;  ///< of them, those that count as directions; likewise
};

inline constexpr float k_splat_share = 1e-6f;

/// The buffer is reused from call to call without allocation once it is large enough.
void gather(const PathTracer& tracer, std::span<const Receiver> receivers, SampleRange samples,
            const GatherOptions& options, GatherBuffer& buffer, PathTracer::Scratch& scratch);

}  // namespace lobelia
