// The nearest usable neighbours of a texel, for filling it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/lightmap.h"

namespace lobelia {

/// Returns whether a texel is baked and valid.
[[nodiscard]] inline bool is_usable(const LightmapPage& page, std::size_t i, float least_validity) {
    return page.chart[i] != 0 && page.validity[i] >= least_validity;
}

class NearestTexels {
  public:
    /// Texels marked in `excluded` (one byte per texel; empty: none) are not usable. The arguments must outlive it.
    NearestTexels(const LightmapPage& page, std::size_t radius, float least_validity,
                  std::span<const std::uint8_t> excluded = {});

    /// Replaces `out` by the texels whose mean fills texel i: all usable ones at the minimum distance, of its own chart
    /// if it has one and there are any. Only i itself if it is usable; empty if none are within the radius.
    void find(std::size_t i, std::vector<std::uint32_t>& out) const;

  private:
    struct Offset {
        int x, y, squared;
    };
    enum class Charts { own, any };
    void find(std::size_t i, Charts charts, std::vector<std::uint32_t>& out) const;

    [[nodiscard]] bool usable(std::size_t i) const {
        return is_usable(page_, i, least_validity_) && (excluded_.empty() || excluded_[i] == 0);
    }

    const LightmapPage& page_;
    std::span<const std::uint8_t> excluded_;
    float least_validity_;
    std::vector<Offset> offsets_;  ///< sorted by distance
};

}  // namespace lobelia
