// Sampling weights: estimates of each light group's irradiance at a point.
#pragma once

#include <array>

#include "trace/light/light_source.h"

namespace lobelia {

/// A shading point. Light from below the plane through `position` with `normal` is ignored; a zero normal accepts light
/// from all directions.
struct Vantage {
    Vec3 position;
    Vec3 normal;
};

inline constexpr std::size_t k_most_groups = 64;
using GroupWeights = std::array<float, k_most_groups>;

/// Parameters of the groups as a structure of arrays: all weights are evaluated for every shading point.
class LightWeights {
  public:
    /// Rows, with one value per group: its bounding sphere; the plane in front of which it is visible; its strength;
    /// `near`, 1 or 0 (far sources, whose centre is a direction); `nearest`, the minimum of the squared distance in the
    /// estimate.
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
    /// Estimates each group's irradiance; 0 where none of it can reach the point. Returns the sum.
    float weigh(const Vantage& at, GroupWeights& weights) const;

  private:
    Rows rows_;
    std::size_t size_ = 0;
};

}  // namespace lobelia
