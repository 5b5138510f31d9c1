// Structure-of-arrays storage: N float channels of one length, and views of consecutive entries of them.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

#include "lobelia/math.h"

namespace lobelia {

/// Kernels read whole groups of this many floats, so every channel can be read up to the next multiple of it.
/// It is the widest vector of any supported machine (512 bits).
inline constexpr std::size_t k_lanes = 16;

[[nodiscard]] constexpr std::size_t round_up_to_lanes(std::size_t n) { return (n + k_lanes - 1) / k_lanes * k_lanes; }

/// A view of `size` consecutive entries of N channels, `stride` floats apart. It is made by `Planes`, and so each
/// channel may be read (not written) up to `round_up_to_lanes(size)`; what lies there beyond `size` is unspecified.
template <std::size_t N, class Float>
struct PlanesView {
    Float* data = nullptr;
    std::size_t stride = 0;
    std::size_t size = 0;

    [[nodiscard]] Float* channel(std::size_t i) const { return data + i * stride; }
    /// Entries [begin, begin + count); `begin` is a multiple of k_lanes.
    [[nodiscard]] PlanesView part(std::size_t begin, std::size_t count) const {
        assert(begin % k_lanes == 0 && begin + count <= size);
        return {data + begin, stride, count};
    }
    /// The M channels from `first` on.
    template <std::size_t M>
    [[nodiscard]] PlanesView<M, Float> channels(std::size_t first) const {
        static_assert(M <= N);
        return {data + first * stride, stride, size};
    }
    operator PlanesView<N, const Float>() const {  // NOLINT(google-explicit-constructor): as T* to const T*
        return {data, stride, size};
    }
};

/// N channels of `size` floats each, zero at first. Channels are padded with zeros to a multiple of k_lanes.
template <std::size_t N>
class Planes {
  public:
    using View = PlanesView<N, const float>;
    using MutableView = PlanesView<N, float>;

    Planes() = default;
    explicit Planes(std::size_t size) : size_(size), stride_(round_up_to_lanes(size)), data_(N * stride_) {}

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] float* channel(std::size_t i) { return data_.data() + i * stride_; }
    [[nodiscard]] const float* channel(std::size_t i) const { return data_.data() + i * stride_; }
    [[nodiscard]] View view() const { return {data_.data(), stride_, size_}; }
    [[nodiscard]] MutableView view() { return {data_.data(), stride_, size_}; }
    operator View() const { return view(); }   // NOLINT(google-explicit-constructor): a container is its whole view
    operator MutableView() { return view(); }  // NOLINT(google-explicit-constructor)

  private:
    std::size_t size_ = 0;
    std::size_t stride_ = 0;
    std::vector<float> data_;
};

/// Unit directions x, y, z.
using Directions = Planes<3>;
using DirectionView = Directions::View;
/// Colours r, g, b: radiances or irradiances.
using Colours = Planes<3>;
using ColourView = Colours::View;
using MutableColourView = Colours::MutableView;

/// Entry i of three channels, as a vector or a colour.
template <class Triple, class Float>
[[nodiscard]] Triple entry(const PlanesView<3, Float>& view, std::size_t i) {
    assert(i < view.size);
    return {view.channel(0)[i], view.channel(1)[i], view.channel(2)[i]};
}
[[nodiscard]] inline Vec3 direction_at(const DirectionView& view, std::size_t i) { return entry<Vec3>(view, i); }
[[nodiscard]] inline Rgb colour_at(const ColourView& view, std::size_t i) { return entry<Rgb>(view, i); }

inline void set_entry(const PlanesView<3, float>& view, std::size_t i, Vec3 v) {
    assert(i < view.size);
    view.channel(0)[i] = v.x;
    view.channel(1)[i] = v.y;
    view.channel(2)[i] = v.z;
}
inline void set_entry(const PlanesView<3, float>& view, std::size_t i, Rgb c) {
    set_entry(view, i, Vec3{c.r, c.g, c.b});
}

/// Every colour times `factor`.
inline void scale(const MutableColourView& colours, float factor) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < colours.size; ++i) colours.channel(k)[i] *= factor;
}

/// Turns irradiance E into E / pi, the radiance that leaves a white diffuse surface.
inline constexpr auto k_over_pi = static_cast<float>(1 / k_pi);

}  // namespace lobelia
