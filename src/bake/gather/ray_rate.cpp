// Measures the ray rate.
#include "bake/gather/ray_rate.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <chrono>

#include "bake/place/texels.h"

namespace lobelia {
namespace {

using Clock = std::chrono::steady_clock;

/// Returns receivers spread evenly over the map, with keys from 0.
std::vector<Receiver> some_receivers(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer,
                                     std::size_t count) {
    std::vector<Receiver> result, one;
    for (std::size_t i = 0; i < std::min(count, map.texels.size()); ++i) {
        const std::size_t at = i * map.texels.size() / std::min(count, map.texels.size());
        make_receivers(atlas, map, at, at + 1, tracer, Switch::off, one);
        one[0].key = static_cast<std::uint32_t>(i);
        result.push_back(one[0]);
    }
    return result;
}

struct Worker {
    std::unique_ptr<PathTracer::Scratch, void (*)(PathTracer::Scratch*)> scratch;
    GatherBuffer buffer;
};

}  // namespace

RayRate measure_rate(const Atlas& atlas, const TexelMap& map, const PathTracer& tracer, const GatherOptions& options) {
    constexpr std::size_t k_texels = 2048, k_at_a_time = 64;
    constexpr std::uint32_t k_samples = 16, k_most_passes = 1024;
    constexpr double k_enough_seconds = 0.25;
    const std::vector<Receiver> receivers = some_receivers(atlas, map, tracer, k_texels);
    if (receivers.empty()) return {};
    tbb::enumerable_thread_specific<Worker> workers([&] { return Worker{tracer.make_scratch(), {}}; });

    const auto start = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::uint32_t passes = 0;
    for (; passes == 0 || (seconds() < k_enough_seconds && passes < k_most_passes); ++passes)
        tbb::parallel_for(std::size_t{0}, (receivers.size() + k_at_a_time - 1) / k_at_a_time, [&](std::size_t group) {
            Worker& worker = workers.local();
            const std::size_t begin = group * k_at_a_time, count = std::min(k_at_a_time, receivers.size() - begin);
            gather(tracer, std::span(receivers).subspan(begin, count), {passes * k_samples, k_samples}, options,
                   worker.buffer, *worker.scratch);
        });

    std::uint64_t rays = 0;
    for (const Worker& worker : workers) rays += PathTracer::rays(*worker.scratch);
    const double samples = static_cast<double>(receivers.size()) * passes * k_samples;
    return {static_cast<double>(rays) / seconds(), static_cast<double>(rays) / samples};
}

}  // namespace lobelia
