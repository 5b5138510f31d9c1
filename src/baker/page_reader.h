// Pages read as light: coefficients that differ from place to place, each in a direction of its own.
#pragma once

#include <span>
#include <vector>

#include "baker/atlas.h"
#include "baker/pages.h"
#include "lobelia/codec.h"

namespace lobelia {

/// Reads up to k_block_size coefficient vectors at once, each in one direction. Not to be shared between threads.
class CoefficientReader {
  public:
    /// The codec must outlive the reader.
    explicit CoefficientReader(const Codec& codec);

    /// Floats of a block: coefficient i, channel k of vector j is at [(3 * i + k) * k_block_size + j].
    [[nodiscard]] std::size_t block_floats() const { return 3 * size_ * k_block_size; }
    /// E [W/m^2] of vector j at normal j, as the evaluator means it. `normals` and `out` have at most k_block_size.
    void irradiance(std::span<const float> block, DirectionView normals, MutableColourView out);
    /// L [W/(m^2 sr)] of vector j in direction j; clamped at 0 where the evaluator clamps.
    void radiance(std::span<const float> block, DirectionView directions, MutableColourView out);

  private:
    void sum(const FunctionSet& functions, std::span<const float> block, DirectionView directions,
             MutableColourView out);

    const Codec* codec_;
    std::size_t size_;
    std::vector<float> rows_;
    std::vector<Rgb> c_;
    Directions one_{1};
    Colours value_{1};
};

/// A bake's pages and what reads them.
struct BakedLight {
    std::span<const Page> pages;
    std::span<const AtlasPlacement> placements;  ///< of each object
    PageLayout layout;
    const Codec* codec = nullptr;   ///< null: pages hold irradiance alone
    bool in_tangent_frame = false;  ///< directions of the coefficients are in each texel's tangent frame
};

/// E [W/m^2] as the codec gives it at each texel's normal, for every page; black where a normal is zero. Without a
/// codec, the irradiance of the paths. `normals`: of each page's texels, in the world, as many as the page has.
[[nodiscard]] std::vector<std::vector<Rgb>> texel_irradiance(const BakedLight& light,
                                                             std::span<const std::vector<Vec3>> normals);

}  // namespace lobelia
