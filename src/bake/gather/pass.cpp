// One pass over receivers: gather, encode, update statistics.
#include "bake/gather/pass.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobelia {
namespace {

/// Receivers gathered at a time: enough paths to fill the tracer, few enough for their samples to stay in the cache.
constexpr std::size_t k_receivers_at_once = 64;

}  // namespace

float ReceiverSummary::relative_error() const {
    if (error == 0) return 0;
    const float mean = luminance(irradiance);
    return mean > 0 ? error / mean : std::numeric_limits<float>::infinity();
}

ReceiverSummary summary(std::span<const float, StateLayout::k_record> record, std::uint32_t samples_per_pass) {
    const float passes = record[StateLayout::k_passes];
    if (!(passes > 0)) return {};
    ReceiverSummary result;
    result.irradiance = Rgb{record[StateLayout::k_irradiance], record[StateLayout::k_irradiance + 1],
                            record[StateLayout::k_irradiance + 2]} *
                        (1 / passes);
    const float mean = luminance(result.irradiance);
    const float variance = std::max(0.0f, record[StateLayout::k_squared] / passes - mean * mean);
    result.error = passes > 1 ? std::sqrt(variance / (passes - 1)) : std::numeric_limits<float>::infinity();
    result.validity = 1 - record[StateLayout::k_back_faces] / (passes * static_cast<float>(samples_per_pass));
    return result;
}

void PassWorker::run(std::span<const Receiver> receivers, const StateLayout& layout, const Encoder* encoder,
                     std::span<float> states, const PassOptions& options) {
    const auto state_of = [&](std::size_t i) { return states.subspan(i * layout.floats(), layout.floats()); };
    // An error estimate from fewer passes than this is itself too uncertain to stop on.
    constexpr float k_fewest_passes = 4;

    for (std::size_t begin = 0; begin < receivers.size(); begin += k_receivers_at_once) {
        // Leave out receivers that are done.
        batch_.clear();
        active_.clear();
        for (std::size_t i = begin; i < std::min(begin + k_receivers_at_once, receivers.size()); ++i) {
            const auto record = layout.record(state_of(i));
            if (options.target_error && record[StateLayout::k_passes] >= k_fewest_passes &&
                summary(record, options.samples.count).relative_error() < *options.target_error)
                continue;
            batch_.push_back(receivers[i]);
            active_.push_back(static_cast<std::uint32_t>(i));
        }
        if (batch_.empty()) continue;

        // Gather light and add it to the encoder states; nothing else keeps the samples.
        gather(*tracer_, batch_, options.samples, options.gather, buffer_, *scratch_);
        for (std::size_t r = 0; r < active_.size(); ++r) {
            const auto state = state_of(active_[r]);
            if (encoder != nullptr) {
                encoder->add(layout.encoder(state), buffer_.directions(r));
                if (buffer_.sources(r).size > 0) encoder->add_sources(layout.encoder(state), buffer_.sources(r));
            }
            const Gathered& gathered = buffer_.gathered(r);
            const auto record = layout.record(state);
            record[StateLayout::k_irradiance] += gathered.irradiance.r;
            record[StateLayout::k_irradiance + 1] += gathered.irradiance.g;
            record[StateLayout::k_irradiance + 2] += gathered.irradiance.b;
            const float y = luminance(gathered.irradiance);
            record[StateLayout::k_squared] += y * y;
            record[StateLayout::k_passes] += 1;
            record[StateLayout::k_back_faces] += static_cast<float>(gathered.back_faces);
        }
    }
}

}  // namespace lobelia
