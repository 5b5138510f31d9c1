// What every file of vectorised loops starts with: the vector type and stores that end where the data ends. For sources
// that Highway includes once for each target, after highway.h.
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

/// The directions from entry j on.
struct Lanes3 {
    V x, y, z;
};
HWY_INLINE Lanes3 load(D d, const DirectionView& directions, std::size_t j) {
    return {hn::LoadU(d, directions.channel(0) + j), hn::LoadU(d, directions.channel(1) + j),
            hn::LoadU(d, directions.channel(2) + j)};
}
HWY_INLINE V dot(D d, const Vec3& a, const Lanes3& b) {
    return hn::MulAdd(hn::Set(d, a.x), b.x, hn::MulAdd(hn::Set(d, a.y), b.y, hn::Mul(hn::Set(d, a.z), b.z)));
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
