// Structure-of-arrays storage: N float channels of one length, and views of consecutive entries of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "lobelia/contract.h"
#include "lobelia/math.h"

namespace lobelia {

/// Maximum number of floats in a vector of any supported machine (512 bits); kernels work on groups of at most this
/// many.
inline constexpr std::size_t k_lanes = 16;

[[nodiscard]] constexpr std::size_t round_up_to_lanes(std::size_t n) { return (n + k_lanes - 1) / k_lanes * k_lanes; }

/// A view of `size` entries of N channels, each an array of floats anywhere in memory: those of `Planes`, or the
/// caller's own, as `DirectionView{{x, y, z}, count}`. Nothing outside [0, size) is read or written; alignment is free.
template <std::size_t N, class Float>
struct PlanesView {
    std::array<Float*, N> pointers{};
    std::size_t size = 0;

    [[nodiscard]] Float* channel(std::size_t i) const { return pointers[i]; }
    /// Returns entries [begin, begin + count).
    [[nodiscard]] PlanesView part(std::size_t begin, std::size_t count) const {
        LOBELIA_ASSERT(begin + count <= size);
        PlanesView result{pointers, count};
        for (Float*& pointer : result.pointers) pointer += begin;
        return result;
    }
    /// Returns the M channels from `first` on.
    template <std::size_t M>
    [[nodiscard]] PlanesView<M, Float> channels(std::size_t first) const {
        static_assert(M <= N);
        LOBELIA_ASSERT(first + M <= N);
        PlanesView<M, Float> result{{}, size};
        std::copy_n(pointers.begin() + static_cast<std::ptrdiff_t>(first), M, result.pointers.begin());
        return result;
    }
    operator PlanesView<N, const Float>() const {  // NOLINT(google-explicit-constructor): as T* to const T*
        PlanesView<N, const Float> result{{}, size};
        std::copy(pointers.begin(), pointers.end(), result.pointers.begin());
        return result;
    }
};

/// N channels of `size` floats each, zero at first; each begins at a multiple of k_lanes floats.
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
    [[nodiscard]] View view() const { return view_of<View>(*this); }
    [[nodiscard]] MutableView view() { return view_of<MutableView>(*this); }
    operator View() const { return view(); }   // NOLINT(google-explicit-constructor): a container is its whole view
    operator MutableView() { return view(); }  // NOLINT(google-explicit-constructor)

  private:
    template <class AnyView>
    [[nodiscard]] static AnyView view_of(auto& planes) {
        AnyView view{{}, planes.size_};
        for (std::size_t i = 0; i < N; ++i) view.pointers[i] = planes.channel(i);
        return view;
    }

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

/// Returns entry i of three channels, as a vector or a colour.
template <class Triple, class Float>
[[nodiscard]] Triple entry(const PlanesView<3, Float>& view, std::size_t i) {
    LOBELIA_ASSERT_BELOW("index of an entry", i, view.size);
    return {view.channel(0)[i], view.channel(1)[i], view.channel(2)[i]};
}
[[nodiscard]] inline Vec3 direction_at(const DirectionView& view, std::size_t i) { return entry<Vec3>(view, i); }
[[nodiscard]] inline Rgb colour_at(const ColourView& view, std::size_t i) { return entry<Rgb>(view, i); }

inline void set_entry(const PlanesView<3, float>& view, std::size_t i, Vec3 v) {
    LOBELIA_ASSERT_BELOW("index of an entry", i, view.size);
    view.channel(0)[i] = v.x;
    view.channel(1)[i] = v.y;
    view.channel(2)[i] = v.z;
}
inline void set_entry(const PlanesView<3, float>& view, std::size_t i, Rgb c) {
    set_entry(view, i, Vec3{c.r, c.g, c.b});
}

/// Returns every colour times `factor`.
inline void scale(const MutableColourView& colours, float factor) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < colours.size; ++i) colours.channel(k)[i] *= factor;
}

/// Converts irradiance E to E / pi, the radiance that leaves a white diffuse surface.
inline constexpr auto k_over_pi = static_cast<float>(1 / k_pi);

}  // namespace lobelia
