// Regions of a bake, one after another: their states from the checkpoint, the passes that are missing, and the
// checkpoint after each pass.
#pragma once

#include <chrono>
#include <mutex>

#include "bake/session/checkpoint.h"
#include "bake/session/setup.h"
#include "lobelia/bake.h"

namespace lobelia {

/// A region after its last pass.
struct GatheredRegion {
    std::vector<std::uint32_t> texels;  ///< indices into the setup's map
    std::vector<Receiver> receivers;    ///< one for each
    RegionStates states;
};

class RegionGatherer {
  public:
    /// `checkpoint` is a folder; empty: none. All arguments must outlive the gatherer.
    RegionGatherer(const BakeSetup& setup, const BakeSession& session, std::filesystem::path checkpoint);

    /// Runs all passes that the region's checkpoint lacks. Errors: an early stop, or a checkpoint of another bake.
    [[nodiscard]] Result<GatheredRegion> gather(std::size_t region);

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] Result<RegionStates> states_of(std::size_t region, std::span<const std::uint32_t> texels) const;
    void run_pass(GatheredRegion& region, std::span<const std::uint32_t> first_of_tile, std::uint32_t pass);
    void report(std::uint32_t pass);
    [[nodiscard]] double error_of(const RegionStates& states) const;
    [[nodiscard]] bool stopped() const;

    const BakeSetup& setup_;
    const BakeSession& session_;
    std::filesystem::path checkpoint_;
    Clock::time_point start_ = Clock::now(), shown_ = start_;
    std::uint64_t tiles_done_ = 0, tiles_all_ = 0, rays_ = 0;
    double error_ = 0;
    std::mutex mutex_;
};

}  // namespace lobelia
