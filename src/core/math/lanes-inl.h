// Shared by all files of vectorised loops: the vector type, loads and stores limited to the data, sums of colours. For
// sources that Highway includes once for each target, after highway.h.
#if defined(LOBELIA_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_LANES_INL_H
#undef LOBELIA_LANES_INL_H
#else
#define LOBELIA_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "lobelia/planes.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, k_lanes>;
using V = hn::Vec<D>;

/// Stores lanes j .. of a row of `size` floats, nothing beyond its end.
HWY_INLINE void store(D d, V v, float* row, std::size_t j, std::size_t size) {
    if (j + hn::Lanes(d) <= size) {
        hn::StoreU(v, d, row + j);
    } else {
        alignas(64) float lanes[k_lanes];
        hn::Store(v, d, lanes);
        std::copy_n(lanes, size - j, row + j);
    }
}

/// Loads lanes j .. of a row of `size` floats; zero beyond its end, where nothing is read.
HWY_INLINE V load(D d, const float* row, std::size_t j, std::size_t size) {
    if (j + hn::Lanes(d) <= size) return hn::LoadU(d, row + j);
    alignas(64) float lanes[k_lanes] = {};
    std::copy_n(row + j, size - j, lanes);
    return hn::Load(d, lanes);
}

/// The directions from entry j on.
struct Lanes3 {
    V x, y, z;
};
HWY_INLINE Lanes3 load(D d, const DirectionView& directions, std::size_t j) {
    return {load(d, directions.channel(0), j, directions.size), load(d, directions.channel(1), j, directions.size),
            load(d, directions.channel(2), j, directions.size)};
}
HWY_INLINE V dot(D d, const Vec3& a, const Lanes3& b) {
    return hn::MulAdd(hn::Set(d, a.x), b.x, hn::MulAdd(hn::Set(d, a.y), b.y, hn::Mul(hn::Set(d, a.z), b.z)));
}

/// The sum of `count` colours c_i times weights, each weight in all lanes of a vector of DC. Red, green and blue lie
/// side by side in one vector; plain code has a float for each.
#if HWY_TARGET == HWY_SCALAR
using DC = hn::CappedTag<float, 1>;
class ColourSum {
  public:
    ColourSum(const Rgb* c, std::size_t) : c_(c) {}
    void add(std::size_t i, hn::Vec<DC> weight) { sum_ = sum_ + c_[i] * hn::GetLane(weight); }
    void add_even(std::size_t i, hn::Vec<DC> weight) { add(i, weight); }
    void add_odd(std::size_t i, hn::Vec<DC> weight) { add(i, weight); }
    [[nodiscard]] Rgb total() const { return sum_; }

  private:
    const Rgb* c_;
    Rgb sum_;
};
#else
using DC = hn::CappedTag<float, 4>;
class ColourSum {
  public:
    HWY_INLINE ColourSum(const Rgb* c, std::size_t count) : c_(c), count_(count) {}
    // Two sums, so that additions do not all wait for each other.
    HWY_INLINE void add_even(std::size_t i, hn::Vec<DC> weight) { even_ = hn::MulAdd(colour(i), weight, even_); }
    HWY_INLINE void add_odd(std::size_t i, hn::Vec<DC> weight) { odd_ = hn::MulAdd(colour(i), weight, odd_); }
    HWY_INLINE void add(std::size_t i, hn::Vec<DC> weight) {
        if (i % 2 == 0)
            add_even(i, weight);
        else
            add_odd(i, weight);
    }
    [[nodiscard]] HWY_INLINE Rgb total() const {
        alignas(16) float lanes[4];
        hn::Store(hn::Add(even_, odd_), DC(), lanes);
        return {lanes[0], lanes[1], lanes[2]};
    }

  private:
    /// Colour i and a fourth float of no meaning. The last colour is loaded from one float before it, since nothing
    /// beyond it may be read.
    [[nodiscard]] HWY_INLINE hn::Vec<DC> colour(std::size_t i) const {
        const DC d;
        const float* const first = &c_[i].r;
        if (HWY_LIKELY(i + 1 < count_)) return hn::LoadU(d, first);
        if (HWY_LIKELY(i > 0)) return hn::Shuffle0321(hn::LoadU(d, first - 1));
        alignas(16) const float only[4] = {c_[0].r, c_[0].g, c_[0].b, 0};
        return hn::Load(d, only);
    }

    const Rgb* c_;
    std::size_t count_;
    hn::Vec<DC> even_ = hn::Zero(DC()), odd_ = hn::Zero(DC());
};
#endif

/// sum_i weights_i c_i of `count` colours.
HWY_INLINE Rgb weighted_sum(const float* weights, const Rgb* c, std::size_t count) {
    const DC d;
    ColourSum sum(c, count);
    std::size_t i = 0;
    for (; i + 2 <= count; i += 2) {
        sum.add_even(i, hn::Set(d, weights[i]));
        sum.add_odd(i + 1, hn::Set(d, weights[i + 1]));
    }
    if (i < count) sum.add_even(i, hn::Set(d, weights[i]));
    return sum.total();
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
