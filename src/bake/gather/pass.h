// Passes of samples over receivers, and the state that each receiver keeps between them.
#pragma once

#include <vector>

#include "bake/gather/gather.h"
#include "lobelia/codec.h"

namespace lobelia {

/// Layout of one receiver's state: the encoder's floats, then a record of sums over passes.
class StateLayout {
  public:
    explicit StateLayout(const Encoder* encoder) : encoder_floats_(encoder == nullptr ? 0 : encoder->state_size()) {}
    [[nodiscard]] std::size_t floats() const { return encoder_floats_ + k_record; }
    [[nodiscard]] std::size_t bytes() const { return floats() * sizeof(float); }
    [[nodiscard]] std::span<float> encoder(std::span<float> state) const { return state.first(encoder_floats_); }
    [[nodiscard]] std::span<const float> encoder(std::span<const float> state) const {
        return state.first(encoder_floats_);
    }

    /// Sums over passes; each pass gives one estimate E of the irradiance (Gathered::irradiance).
    enum Record : std::size_t { k_irradiance, k_squared = k_irradiance + 3, k_passes, k_back_faces, k_record };
    [[nodiscard]] std::span<float, k_record> record(std::span<float> state) const {
        return state.subspan(encoder_floats_).first<k_record>();
    }
    [[nodiscard]] std::span<const float, k_record> record(std::span<const float> state) const {
        return state.subspan(encoder_floats_).first<k_record>();
    }

  private:
    std::size_t encoder_floats_;
};

/// Statistics of a record: mean E, standard error of its luminance, fraction of paths that hit no back face first.
struct ReceiverSummary {
    Rgb irradiance;
    float error = 0;
    float validity = 0;
    /// Standard error over mean; infinite before the second pass, 0 where all passes gave 0.
    [[nodiscard]] float relative_error() const;
};
[[nodiscard]] ReceiverSummary summary(std::span<const float, StateLayout::k_record> record,
                                      std::uint32_t samples_per_pass);

struct PassOptions {
    GatherOptions gather;
    SampleRange samples;
    std::optional<double> target_error;  ///< receivers with a smaller relative error are skipped
};

/// Runs passes over many receivers on one thread.
class PassWorker {
  public:
    explicit PassWorker(const PathTracer& tracer) : tracer_(&tracer), scratch_(tracer.make_scratch()) {}
    /// Adds a pass to each receiver. `encoder` may be null: irradiance only.
    /// Precondition: `states` has layout.floats() for each receiver.
    void run(std::span<const Receiver> receivers, const StateLayout& layout, const Encoder* encoder,
             std::span<float> states, const PassOptions& options);
    [[nodiscard]] std::uint64_t rays() const { return PathTracer::rays(*scratch_); }

  private:
    const PathTracer* tracer_;
    std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> scratch_;
    GatherBuffer buffer_;
    std::vector<Receiver> batch_;
    std::vector<std::uint32_t> active_;
};

}  // namespace lobelia
