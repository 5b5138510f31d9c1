// The environment as a light source: directions by its brightness, one texel after another without gaps.
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

/// Chooses a row, then a texel of it, in proportion to luminance times solid angle; then uniformly within the texel's
/// solid angle. Radiance is constant over a texel. Sums stay short, so that float32 tables are exact enough.
class EnvironmentLight {
  public:
    enum class Choice { by_brightness, uniform };
    /// `image` must outlive this; precondition: at least one texel has luminance above 0.
    EnvironmentLight(const Image& image, Choice choice);

    /// A direction and the texel that it came from, which `look` reads.
    struct Drawn {
        Vec3 direction;
        std::size_t texel = 0;
    };
    [[nodiscard]] Drawn draw(Pair point) const;
    [[nodiscard]] EnvironmentSample look(const Drawn& drawn) const;
    [[nodiscard]] EnvironmentSample sample(Pair point) const { return look(draw(point)); }
    [[nodiscard]] float pdf(Vec3 direction) const;
    /// A point that is mapped to `direction`; one with pdf 0 has none.
    [[nodiscard]] Pair inverse(Vec3 direction) const;
    /// Radiance and pdf there.
    [[nodiscard]] EnvironmentSample at(Vec3 direction) const { return look({direction, texel(direction).index}); }
    /// Luminance of the mean radiance [W/(m^2 sr)].
    [[nodiscard]] float mean_luminance() const { return mean_luminance_; }

  private:
    struct Texel {
        std::size_t x, y, index;
    };
    [[nodiscard]] Texel texel(Vec3 direction) const;

    const Image* image_;
    Choice choice_;
    std::vector<float> cosine_;  ///< of the polar angle, at the edges between rows
    std::vector<AliasTable> rows_;
    std::vector<AliasTable> columns_;  ///< one for each row
    float mean_luminance_ = 0;
    float density_ = 0;  ///< pdf over the texel's luminance
};

}  // namespace lobelia
