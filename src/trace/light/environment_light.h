// The environment as a light source: directions sampled by brightness, piecewise constant over texels.
// Pharr, Jakob and Humphreys 2023, 12.5 (the idea); Vose 1991 (alias tables).
#pragma once

#include <algorithm>
#include <vector>

#include "core/sample/sequence.h"
#include "lobelia/environment.h"
#include "lobelia/sampling.h"

namespace lobelia {

/// Luminance, never below 0 whatever an image holds.
[[nodiscard]] inline float brightness(Rgb radiance) { return std::max(0.0f, luminance(radiance)); }

/// A direction towards the environment.
struct EnvironmentSample {
    Vec3 direction;
    Rgb radiance;
    float pdf = 0;  ///< [1/sr]
};

/// Samples a row, then a texel of it, in proportion to luminance times solid angle; then a direction uniformly within
/// the texel's solid angle. Radiance is constant over a texel. Tables per row keep sums short, so that float32 is exact
/// enough.
class EnvironmentLight {
  public:
    enum class Choice { by_brightness, uniform };
    /// `image` must outlive this; precondition: at least one texel has luminance above 0.
    EnvironmentLight(const Image& image, Choice choice);

    /// A sampled direction and its texel; the argument of `evaluate`.
    struct Drawn {
        Vec3 direction;
        std::size_t texel = 0;
    };
    [[nodiscard]] Drawn draw(Pair point) const;
    [[nodiscard]] EnvironmentSample evaluate(const Drawn& drawn) const;
    [[nodiscard]] EnvironmentSample sample(Pair point) const { return evaluate(draw(point)); }
    [[nodiscard]] float pdf(Vec3 direction) const;
    /// Returns the point that `sample` maps to `direction`. Precondition: pdf(direction) > 0.
    [[nodiscard]] Pair inverse(Vec3 direction) const;
    /// Returns radiance and pdf of `direction`.
    [[nodiscard]] EnvironmentSample at(Vec3 direction) const { return evaluate({direction, texel(direction).index}); }
    /// Returns the luminance of the mean radiance [W/(m^2 sr)].
    [[nodiscard]] float mean_luminance() const { return mean_luminance_; }

  private:
    struct Texel {
        std::size_t x, y, index;
    };
    [[nodiscard]] Texel texel(Vec3 direction) const;

    const Image* image_;
    Choice choice_;
    std::vector<float> cosine_;  ///< polar angle's cosine at the edges between rows
    std::vector<AliasTable> rows_;
    std::vector<AliasTable> columns_;  ///< one for each row
    float mean_luminance_ = 0;
    float density_ = 0;  ///< pdf divided by the texel's luminance
};

}  // namespace lobelia
