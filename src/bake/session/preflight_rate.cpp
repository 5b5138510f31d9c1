// How fast light is traced: a short try.
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <chrono>

#include "bake/place/texels.h"
#include "bake/session/preflight.h"

namespace lobelia {
namespace {

using Clock = std::chrono::steady_clock;

/// Texels that are evenly spread over the map.
std::vector<Texel> some_texels(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer, std::size_t count) {
    std::vector<Texel> result, one;
    for (std::size_t i = 0; i < std::min(count, map.texels.size()); ++i) {
        const std::size_t at = i * map.texels.size() / std::min(count, map.texels.size());
        make_texels(atlas, map, at, at + 1, tracer, Switch::off, one);
        result.push_back(one[0]);
    }
    return result;
}

/// What one thread works with.
struct Worker {
    std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> scratch;
    GatherBuffer buffer;
    std::vector<Receiver> receivers;
};

}  // namespace

TraceRate measure_rate(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer,
                       const GatherOptions& options) {
    constexpr std::size_t k_texels = 2048, k_at_a_time = 64;
    constexpr std::uint32_t k_samples = 16, k_most_passes = 1024;
    constexpr double k_enough_seconds = 0.25;
    const std::vector<Texel> texels = some_texels(atlas, map, tracer, k_texels);
    if (texels.empty()) return {};
    tbb::enumerable_thread_specific<Worker> workers([&] { return Worker{tracer.make_scratch(), {}, {}}; });

    const auto start = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::uint32_t passes = 0;
    for (; passes == 0 || (seconds() < k_enough_seconds && passes < k_most_passes); ++passes)
        tbb::parallel_for(std::size_t{0}, (texels.size() + k_at_a_time - 1) / k_at_a_time, [&](std::size_t group) {
            Worker& worker = workers.local();
            worker.receivers.clear();
            for (std::size_t i = group * k_at_a_time; i < std::min((group + 1) * k_at_a_time, texels.size()); ++i) {
                Receiver receiver{{texels[i].positions.data(), texels[i].position_count}, texels[i].normal};
                receiver.key = static_cast<std::uint32_t>(i);
                worker.receivers.push_back(receiver);
            }
            gather(tracer, worker.receivers, {passes * k_samples, k_samples}, options, worker.buffer, *worker.scratch);
        });

    std::uint64_t rays = 0;
    for (const Worker& worker : workers) rays += PathTracer::rays(*worker.scratch);
    const double samples = static_cast<double>(texels.size()) * passes * k_samples;
    return {static_cast<double>(rays) / seconds(), static_cast<double>(rays) / samples};
}

}  // namespace lobelia
