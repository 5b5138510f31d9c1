// Radiance samples, one or many: light that arrives from an environment or a path tracer.
#pragma once

#include "lobelia/planes.h"

namespace lobelia {

/// Domain of radiance: all directions, or the upper hemisphere z >= 0 of a tangent frame.
enum class Domain { sphere, hemisphere };

/// Returns the solid angle of the domain [sr].
[[nodiscard]] constexpr double solid_angle(Domain domain) { return domain == Domain::sphere ? 4 * k_pi : 2 * k_pi; }

/// One radiance sample. `solid_angle` [sr] is its share of the domain, 1 / (N pdf): all sum to 4 pi (sphere) or 2 pi
/// (hemisphere). Encoders normalise by the sum, so that any common factor is harmless while N is not known yet.
struct RadianceSample {
    Vec3 direction;
    Rgb radiance;
    float solid_angle = 0;
};

/// A view of samples: x, y, z, r, g, b, solid angle.
struct SampleView : PlanesView<7, const float> {
    [[nodiscard]] DirectionView directions() const { return channels<3>(0); }
    [[nodiscard]] ColourView radiance() const { return channels<3>(3); }
    [[nodiscard]] const float* solid_angles() const { return channel(6); }
    /// Returns samples [begin, begin + count).
    [[nodiscard]] SampleView part(std::size_t begin, std::size_t count) const {
        return {PlanesView<7, const float>::part(begin, count)};
    }
};

/// Samples as a structure of arrays.
class Samples {
  public:
    Samples() = default;
    explicit Samples(std::size_t size) : planes_(size) {}
    explicit Samples(Planes<7> planes) : planes_(std::move(planes)) {}

    [[nodiscard]] std::size_t size() const { return planes_.size(); }
    [[nodiscard]] RadianceSample operator[](std::size_t i) const {
        return {direction_at(view().directions(), i), colour_at(view().radiance(), i), planes_.channel(6)[i]};
    }
    void set(std::size_t i, const RadianceSample& s) {
        set_entry(planes_.view().channels<3>(0), i, s.direction);
        set_entry(planes_.view().channels<3>(3), i, s.radiance);
        planes_.channel(6)[i] = s.solid_angle;
    }
    [[nodiscard]] SampleView view() const { return {planes_.view()}; }
    operator SampleView() const { return view(); }  // NOLINT(google-explicit-constructor)

  private:
    Planes<7> planes_;
};

/// Calls `visit(part)` for consecutive parts of at most `count` entries, in order, with the index of its first.
template <class View, class Visit>
void for_each_part(const View& view, std::size_t count, const Visit& visit) {
    for (std::size_t begin = 0; begin < view.size; begin += count)
        visit(view.part(begin, std::min(count, view.size - begin)), begin);
}

}  // namespace lobelia
