// Passes over the tiles of a region, in parallel; the same bits for any number of threads.
#include "bake/session/regions.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "bake/place/texels.h"
#include "bake/session/continuation.h"

namespace lobelia {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Receiver> receivers_of(const BakeSetup& setup, std::span<const std::uint32_t> texels, StopFlag stop) {
    std::vector<Receiver> receivers(texels.size());
    constexpr std::size_t grain = 1024;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, texels.size(), grain), [&](const auto& range) {
        // Make runs of consecutive texels at once.
        std::vector<Receiver> made;
        for (std::size_t i = range.begin(); i < range.end();) {
            stop.check();
            std::size_t end = i + 1;
            while (end < range.end() && texels[end] == texels[end - 1] + 1) ++end;
            make_receivers(setup.atlas, setup.map, texels[i], texels[end - 1] + 1, *setup.tracer,
                           setup.options.push_out, made);
            std::copy(made.begin(), made.end(), receivers.begin() + static_cast<std::ptrdiff_t>(i));
            i = end;
        }
    });
    return receivers;
}

/// Returns the first texel of each tile of a region, and the end.
std::vector<std::uint32_t> tile_starts(const BakeSetup& setup, TileRange range) {
    std::vector<std::uint32_t> starts = {0};
    for (std::uint32_t place = range.first; place < range.end; ++place) {
        const std::uint32_t tile = setup.plan.tiles[place];
        starts.push_back(starts.back() + setup.map.first_of_tile[tile + 1] - setup.map.first_of_tile[tile]);
    }
    return starts;
}

}  // namespace

RegionGatherer::RegionGatherer(const BakeSetup& setup, const BakeSession& session, std::filesystem::path checkpoint)
    : setup_(setup),
      session_(session),
      checkpoint_(std::move(checkpoint)),
      tiles_all_(std::uint64_t{setup.plan.passes()} * setup.plan.tiles.size()) {}

bool RegionGatherer::stopped() const {
    return session_.stop != nullptr && session_.stop->load(std::memory_order_relaxed);
}

Result<GatheredRegion> RegionGatherer::gather(std::size_t number) {
    // Continue from the checkpoint, if there is one.
    const BakePlan& plan = setup_.plan;
    GatheredRegion region;
    region.texels = plan.texels(setup_.map, number);
    auto states = states_of(number, region.texels);
    if (!states) return states.error();
    region.states = *std::move(states);
    RegionHeader& header = region.states.header;
    const TileRange range = plan.regions[number];
    tiles_done_ += std::uint64_t{header.end_pass - plan.first_pass} * (range.end - range.first);
    region.receivers = receivers_of(setup_, region.texels, session_.stop);

    // Run the missing passes while this region's part of the time limit lasts, and keep each.
    const std::vector<std::uint32_t> first_of_tile = tile_starts(setup_, range);
    const double part = static_cast<double>(number + 1) / static_cast<double>(plan.regions.size());
    const std::optional<double>& limit = setup_.options.most_seconds;
    while (header.end_pass < plan.end_pass && !(limit && seconds_since(start_) >= part * *limit)) {
        const auto pass_start = Clock::now();
        run_pass(region, first_of_tile, header.end_pass);
        if (stopped()) return Error{"stopped", Error::Kind::stopped};
        if (session_.progress) error_ = error_of(region.states);
        ++header.end_pass;
        header.seconds += seconds_since(pass_start);
        if (checkpoint_.empty()) continue;
        if (auto status = region.states.write(region_file(checkpoint_, number)); !status) return status.error();
    }
    return region;
}

Result<RegionStates> RegionGatherer::states_of(std::size_t region, std::span<const std::uint32_t> texels) const {
    RegionStates fresh(texels.size(), setup_.layout.floats());
    fresh.header = expected_header(setup_, region, texels);
    if (checkpoint_.empty()) return fresh;
    const auto path = region_file(checkpoint_, region);
    std::error_code code;
    if (!std::filesystem::exists(path, code)) return fresh;
    auto kept = RegionStates::read(path);
    if (!kept) return kept.error();
    if (auto status = check_header(path, kept->header, fresh.header); !status) return status.error();
    kept->header.instruction_sets = joined(kept->header.instruction_sets, fresh.header.instruction_sets);
    return kept;
}

void RegionGatherer::run_pass(GatheredRegion& region, std::span<const std::uint32_t> first_of_tile,
                              std::uint32_t pass) {
    const PassOptions options = setup_.encoding.pass_options(setup_.options, pass);
    const std::size_t floats = setup_.layout.floats();
    tbb::enumerable_thread_specific<PassWorker> workers([&] { return PassWorker(*setup_.tracer); });
    tbb::parallel_for(std::size_t{0}, first_of_tile.size() - 1, [&](std::size_t tile) {
        if (stopped()) return;
        const std::size_t begin = first_of_tile[tile], count = first_of_tile[tile + 1] - begin;
        PassWorker& worker = workers.local();
        const std::uint64_t before = worker.rays();
        worker.run(std::span(region.receivers).subspan(begin, count), setup_.layout, setup_.encoding.encoder(),
                   region.states.states().subspan(begin * floats, count * floats), options);
        const std::lock_guard lock(mutex_);
        rays_ += worker.rays() - before;
        ++tiles_done_;
        report(pass);
    });
    for (const PassWorker& worker : workers) region.states.header.rays += worker.rays();
}

void RegionGatherer::report(std::uint32_t pass) {
    if (!session_.progress) return;
    const auto now = Clock::now();
    if (std::chrono::duration<double>(now - shown_).count() < 0.1 && tiles_done_ < tiles_all_) return;
    shown_ = now;
    BakeProgress progress;
    const double seconds = seconds_since(start_);
    progress.done = static_cast<double>(tiles_done_) / static_cast<double>(std::max<std::uint64_t>(1, tiles_all_));
    progress.rays_per_second = static_cast<double>(rays_) / std::max(1e-3, seconds);
    progress.seconds_left = progress.done > 0 ? seconds * (1 / progress.done - 1) : 0;
    progress.error = error_;
    progress.pass = pass + 1 - setup_.plan.first_pass;
    progress.passes = setup_.plan.passes();
    session_.progress(progress);
}

/// Returns the RMS of the standard errors over the mean of E, as BakeStatistics::mean_error.
double RegionGatherer::error_of(const RegionStates& states) const {
    double squared = 0, mean = 0, count = 0;
    for (std::size_t i = 0; i < states.header.sites; ++i) {
        const auto state = states.states().subspan(i * setup_.layout.floats(), setup_.layout.floats());
        const ReceiverSummary is = summary(setup_.layout.record(state), setup_.options.samples_per_pass);
        if (is.validity < 0.5f || !std::isfinite(is.error)) continue;
        squared += static_cast<double>(is.error) * is.error;
        mean += luminance(is.irradiance);
        count += 1;
    }
    return mean > 0 ? std::sqrt(squared / count) / (mean / count) : 0;
}

}  // namespace lobelia
