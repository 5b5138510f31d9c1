// How much each group of light sources might bring to a point: what the choice between them goes by.
#pragma once

#include <array>

#include "trace/light/light_source.h"

namespace lobelia {

/// A point that wants light, and the unit normal of the plane from below which none reaches it; (0, 0, 0): none does
/// not.
struct Vantage {
    Vec3 position;
    Vec3 normal;
};

inline constexpr std::size_t k_most_groups = 64;
using GroupWeights = std::array<float, k_most_groups>;

/// The groups' outlines as a structure of arrays, for the weights of all are computed for every point.
class LightWeights {
  public:
    /// Of each group: its bounding sphere, the plane before which its front is seen, its strength; `near` is 1, or 0 of
    /// far sources, whose centre is a direction; `nearest` is the square of the distance below which it does not come.
    enum Row : std::size_t {
        centre_x,
        centre_y,
        centre_z,
        radius,
        front_x,
        front_y,
        front_z,
        least,
        strength,
        near,
        nearest,
        k_row_count
    };
    using Rows = std::array<std::array<float, k_most_groups>, k_row_count>;

    LightWeights();
    void add(const LightGroup& group);
    /// An estimate of each group's irradiance, 0 where none of it can reach the point. Returns their sum.
    float weigh(const Vantage& at, GroupWeights& weights) const;

  private:
    Rows rows_;
    std::size_t size_ = 0;
};

}  // namespace lobelia
