// Places that receive light, texels and probes alike, and what is kept for each while a bake runs.
#pragma once

#include <vector>

#include "bake/gather/gather.h"
#include "lobelia/codec.h"

namespace lobelia {

/// A receiver with its own room for positions.
struct Site {
    static constexpr std::size_t k_most_positions = 4;
    std::array<Vec3, k_most_positions> positions;
    Vec3 normal;  ///< unit
    std::uint32_t key = 0;
    std::uint8_t position_count = 0;
    bool buried = false;  ///< sees back faces all around: no light can come here
};

/// The floats of one site: the encoder's state, then the record.
class SiteLayout {
  public:
    explicit SiteLayout(const Encoder* encoder) : encoder_floats_(encoder == nullptr ? 0 : encoder->state_size()) {}
    [[nodiscard]] std::size_t floats() const { return encoder_floats_ + k_record; }
    [[nodiscard]] std::size_t bytes() const { return floats() * sizeof(float); }
    [[nodiscard]] std::span<float> encoder(std::span<float> site) const { return site.first(encoder_floats_); }
    [[nodiscard]] std::span<const float> encoder(std::span<const float> site) const {
        return site.first(encoder_floats_);
    }

    /// Sums over passes, each of which gave one estimate E of the irradiance (Gathered::irradiance).
    enum Record : std::size_t { k_irradiance, k_squared = k_irradiance + 3, k_passes, k_back_faces, k_record };
    [[nodiscard]] std::span<float, k_record> record(std::span<float> site) const {
        return site.subspan(encoder_floats_).first<k_record>();
    }
    [[nodiscard]] std::span<const float, k_record> record(std::span<const float> site) const {
        return site.subspan(encoder_floats_).first<k_record>();
    }

  private:
    std::size_t encoder_floats_;
};

/// What the record tells: the mean E, the standard error of its luminance, the share of paths that met no back face.
struct SiteSummary {
    Rgb irradiance;
    float error = 0;
    float validity = 0;
    /// Standard error over mean; infinite before the second pass, 0 where all passes gave 0.
    [[nodiscard]] float relative_error() const;
};
[[nodiscard]] SiteSummary summary(std::span<const float, SiteLayout::k_record> record, std::uint32_t samples_per_pass);

/// How a pass goes.
struct PassOptions {
    GatherOptions gather;
    SampleRange samples;
    bool in_tangent_frame = false;       ///< else directions are the world's
    Domain domain = Domain::hemisphere;  ///< of the sites
    std::optional<double> target_error;  ///< sites whose relative error is below it are left alone
};

/// Runs passes over many sites on one thread.
class SiteWorker {
  public:
    explicit SiteWorker(const PathTracer& tracer) : tracer_(&tracer), scratch_(tracer.make_scratch()) {}
    /// Adds a pass to each site; `states` has layout.floats() for each. `encoder` may be null: irradiance alone.
    void run(std::span<const Site> sites, const SiteLayout& layout, const Encoder* encoder, std::span<float> states,
             const PassOptions& options);
    [[nodiscard]] std::uint64_t rays() const { return PathTracer::rays(*scratch_); }

  private:
    const PathTracer* tracer_;
    std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> scratch_;
    GatherBuffer buffer_;
    std::vector<Receiver> receivers_;
    std::vector<std::uint32_t> active_;
};

}  // namespace lobelia
