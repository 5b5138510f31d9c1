// Sampling weights of groups of light sources, vectorised.
#include "trace/light/light_weights.h"

#include <algorithm>
#include <cassert>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/light/light_weights.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

float Weigh(const LightWeights::Rows& rows, std::size_t size, const Vantage& at, GroupWeights& weights) {
    // Use four lanes: most scenes have few groups, and wider vectors cost more than they save.
    const hn::CappedTag<float, 4> d;
    using V = hn::Vec<decltype(d)>;
    const V px = hn::Set(d, at.position.x), py = hn::Set(d, at.position.y), pz = hn::Set(d, at.position.z);
    const V nx = hn::Set(d, at.normal.x), ny = hn::Set(d, at.normal.y), nz = hn::Set(d, at.normal.z);
    V total = hn::Zero(d);
    for (std::size_t g = 0; g < size; g += hn::Lanes(d)) {
        const auto row = [&](std::size_t k) HWY_ATTR { return hn::LoadU(d, rows[k].data() + g); };
        using W = LightWeights;
        const V near = row(W::near), x = hn::NegMulAdd(near, px, row(W::centre_x)),
                y = hn::NegMulAdd(near, py, row(W::centre_y)), z = hn::NegMulAdd(near, pz, row(W::centre_z));
        const V distance2 = hn::Mul(near, hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
        const V weight = hn::Div(row(W::strength), hn::Max(distance2, row(W::nearest)));
        const V above = hn::MulAdd(nx, x, hn::MulAdd(ny, y, hn::MulAdd(nz, z, row(W::radius))));
        const V before =
            hn::Sub(hn::MulAdd(row(W::front_x), px, hn::MulAdd(row(W::front_y), py, hn::Mul(row(W::front_z), pz))),
                    row(W::least));
        const V seen = hn::IfThenElseZero(hn::Ge(hn::Min(above, before), hn::Zero(d)), weight);
        hn::StoreU(seen, d, weights.data() + g);
        total = hn::Add(total, seen);
    }
    return hn::GetLane(hn::SumOfLanes(d, total));
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(Weigh);

LightWeights::LightWeights() {
    // Give unused entries zero strength and a nonzero distance to divide by.
    for (auto& row : rows_) row.fill(0);
    rows_[nearest].fill(1);
}

void LightWeights::add(const LightGroup& group) {
    assert(size_ < k_most_groups);
    const std::array<float, k_row_count> values = {
        group.centre.x,
        group.centre.y,
        group.centre.z,
        group.radius,
        group.front.x,
        group.front.y,
        group.front.z,
        group.least,
        group.strength,
        group.far ? 0.0f : 1.0f,
        group.far ? 1.0f : std::max(group.radius * group.radius, std::numeric_limits<float>::min())};
    for (std::size_t k = 0; k < k_row_count; ++k) rows_[k][size_] = values[k];
    ++size_;
}

float LightWeights::weigh(const Vantage& at, GroupWeights& weights) const {
    return HWY_DYNAMIC_DISPATCH(Weigh)(rows_, size_, at, weights);
}

}  // namespace lobelia
#endif
