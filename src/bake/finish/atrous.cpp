// The filter's inner loops, row by row and tap by tap, vectorised.
#include "bake/finish/atrous.h"

#include <cassert>
#include <cmath>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bake/finish/atrous.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Returns the factor of a term whose filter weight is `weight`.
template <AtrousMean mean, class V>
HWY_INLINE V influence(V weight) {
    if constexpr (mean == AtrousMean::first_variances) return hn::Mul(weight, weight);
    if constexpr (mean == AtrousMean::later_variances) {
        const V root = hn::Sqrt(weight);
        return hn::Mul(hn::Mul(weight, root), hn::Sqrt(root));
    }
    return weight;
}

/// Adds weighted values. Values of weight 0 are ignored, NaN included.
template <AtrousMean mean, class D>
HWY_INLINE void add(D d, const float* weight, const float* value, float* sum, float* total) {
    const auto w = hn::LoadU(d, weight), v = hn::LoadU(d, value);
    auto counts = hn::Gt(w, hn::Zero(d));
    if constexpr (mean == AtrousMean::known_values) counts = hn::And(counts, hn::Eq(v, v));
    const auto term = hn::IfThenElseZero(counts, hn::Mul(influence<mean>(w), v));
    hn::StoreU(hn::Add(hn::LoadU(d, sum), term), d, sum);
    hn::StoreU(hn::Add(hn::LoadU(d, total), hn::IfThenElseZero(counts, w)), d, total);
}

/// Divides sums by total weights. Texels without neighbours or without known values keep their value bit for bit.
template <AtrousMean mean, class D>
HWY_INLINE void divide(D d, const float* sum, const float* total, const float* from, float* to) {
    const auto t = hn::LoadU(d, total);
    const auto alone = hn::Or(hn::Eq(t, hn::Set(d, k_atrous_centre)), hn::Eq(t, hn::Zero(d)));
    const auto quotient = hn::Div(hn::LoadU(d, sum), influence<mean>(t));
    hn::StoreU(hn::IfThenElse(alone, hn::LoadU(d, from), quotient), d, to);
}

/// Calls visit(tag, i) for all lanes, whole vectors first.
template <class Visit>
HWY_INLINE void for_each_lane(std::size_t count, const Visit& visit) {
    const hn::ScalableTag<float> d;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) visit(d, i);
    for (; i < count; ++i) visit(hn::CappedTag<float, 1>(), i);
}

/// Computes row y of the result; `sum` and `total` are buffers of one row.
template <AtrousMean mean>
void average_row(const AtrousWeights& weights, const float* from, std::size_t y, float* to, float* sum, float* total) {
    const std::size_t width = weights.width;
    const float* middle = from + y * width;
    for_each_lane(width, [&](auto d, std::size_t x) {
        const auto centre = hn::Set(d, k_atrous_centre), v = hn::LoadU(d, middle + x);
        const auto term = hn::Mul(influence<mean>(centre), v);
        const auto known = hn::Eq(v, v);
        hn::StoreU(hn::IfThenElseZero(known, term), d, sum + x);
        hn::StoreU(mean == AtrousMean::known_values ? hn::IfThenElseZero(known, centre) : centre, d, total + x);
    });

    for (std::size_t k = 0; k < k_atrous_taps.size(); ++k) {
        const std::size_t dy = static_cast<std::size_t>(k_atrous_taps[k].y) * weights.step;
        const std::size_t dx = static_cast<std::size_t>(std::abs(k_atrous_taps[k].x)) * weights.step;
        if (dx >= width) continue;
        // Weights are stored at the upper of two texels; taps to the left start at column dx.
        const std::size_t here = k_atrous_taps[k].x < 0 ? dx : 0, there = dx - here, count = width - dx;
        const auto add_row = [&](const float* weight, const float* value, std::size_t first) {
            for_each_lane(count, [&](auto d, std::size_t x) {
                add<mean>(d, weight + x, value + x, sum + first + x, total + first + x);
            });
        };
        if (y + dy < weights.height)
            add_row(&weights.weight[k][y * width + here], from + (y + dy) * width + there, here);
        if (y >= dy) add_row(&weights.weight[k][(y - dy) * width + here], from + (y - dy) * width + here, there);
    }
    for_each_lane(width, [&](auto d, std::size_t x) { divide<mean>(d, sum + x, total + x, middle + x, to + x); });
}

void AverageRow(const AtrousWeights& weights, AtrousMean mean, const float* from, std::size_t y, float* to,
                float* sums) {
    float *sum = sums, *total = sums + weights.width;
    switch (mean) {
        case AtrousMean::values:
            return average_row<AtrousMean::values>(weights, from, y, to, sum, total);
        case AtrousMean::known_values:
            return average_row<AtrousMean::known_values>(weights, from, y, to, sum, total);
        case AtrousMean::first_variances:
            return average_row<AtrousMean::first_variances>(weights, from, y, to, sum, total);
        case AtrousMean::later_variances:
            return average_row<AtrousMean::later_variances>(weights, from, y, to, sum, total);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(AverageRow);

void average(const AtrousWeights& weights, AtrousMean mean, const std::vector<float>& from, std::vector<float>& to) {
    assert(from.size() == weights.width * weights.height && to.size() == from.size() && &from != &to);
    std::vector<float> sums(2 * weights.width);
    for (std::size_t y = 0; y < weights.height; ++y) HWY_DYNAMIC_DISPATCH(AverageRow)
    (weights, mean, from.data(), y, to.data() + y * weights.width, sums.data());
}

}  // namespace lobelia
#endif
