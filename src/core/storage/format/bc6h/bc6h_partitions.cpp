// Estimates which partition of a BC6H block promises most, lanes running over the 32 partitions.
#include <cstddef>

#include "core/storage/format/bc6h/bc6h_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/bc6h/bc6h_partitions.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::bc6h::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, k_texels>;
using V = hn::Vec<D>;

HWY_INLINE V load(const float* lanes) { return hn::Load(D(), lanes); }

/// What remains of the scatter of texels with these moments when they lie on their axis in `steps` steps.
HWY_INLINE V residual(const V* m, float steps) {
    const D d;
    const V inverse = hn::Div(hn::Set(d, 1.0f), m[Moment::count]);
    const auto scatter = [&](std::size_t k, std::size_t a, std::size_t b) {
        return hn::NegMulAdd(hn::Mul(m[a], m[b]), inverse, m[k]);
    };
    using M = Moment;
    const V srr = scatter(M::rr, M::r, M::r), srg = scatter(M::rg, M::r, M::g), srb = scatter(M::rb, M::r, M::b),
            sgg = scatter(M::gg, M::g, M::g), sgb = scatter(M::gb, M::g, M::b), sbb = scatter(M::bb, M::b, M::b);
    const V trace = hn::Add(hn::Add(srr, sgg), sbb);
    // The variance along the axis, by powers of the scatter from a start that is not likely to be orthogonal to it.
    V x = hn::Add(srr, hn::Add(hn::Abs(srg), hn::Abs(srb))), y = hn::CopySign(hn::Add(sgg, hn::Abs(sgb)), srg),
      z = hn::CopySign(sbb, srb);
    V squared = hn::Zero(d), value = hn::Zero(d);
    for (int round = 0; round < 3; ++round) {
        const V size = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Add(hn::Abs(z), hn::Set(d, 1e-30f)));
        const V scale = hn::Div(hn::Set(d, 1.0f), size);
        x = hn::Mul(x, scale);
        y = hn::Mul(y, scale);
        z = hn::Mul(z, scale);
        const V u = hn::MulAdd(srr, x, hn::MulAdd(srg, y, hn::Mul(srb, z)));
        const V v = hn::MulAdd(srg, x, hn::MulAdd(sgg, y, hn::Mul(sgb, z)));
        const V w = hn::MulAdd(srb, x, hn::MulAdd(sgb, y, hn::Mul(sbb, z)));
        squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
        value = hn::MulAdd(u, x, hn::MulAdd(v, y, hn::Mul(w, z)));
        x = u;
        y = v;
        z = w;
    }
    const V along = hn::Div(value, hn::Add(squared, hn::Set(d, 1e-30f)));
    return hn::NegMulAdd(along, hn::Set(d, 1 - 1 / (steps * steps)), trace);
}

/// Sums the moments of whole blocks.
HWY_INLINE void sum_whole(const Texels& t, RegionMoments& m) {
    const D d;
    for (std::size_t k = 0; k < k_texels; k += hn::Lanes(d)) {
        V sum = hn::Zero(d);
        for (std::size_t i = 0; i < k_texels; ++i) sum = hn::Add(sum, load(t.moments[i] + k));
        hn::Store(sum, d, m.whole + k);
    }
}

float EstimateErrors(const Texels& t, RegionMoments& m, float* estimates) {
    const D d;
    sum_whole(t, m);
    V whole[Moment::total];
    for (std::size_t k = 0; k < Moment::total; ++k) whole[k] = hn::Set(d, m.whole[k]);
    for (std::size_t p = 0; p < k_partitions; p += hn::Lanes(d)) {
        V second[Moment::total], first[Moment::total];
        for (auto& v : second) v = hn::Zero(d);
        for (std::size_t i = 0; i < k_texels; ++i) {
            const V member = load(k_partition_table.member[i] + p);
            for (std::size_t k = 0; k < Moment::total; ++k)
                second[k] = hn::MulAdd(member, hn::Set(d, t.moments[i][k]), second[k]);
        }
        for (std::size_t k = 0; k < Moment::total; ++k) {
            hn::Store(second[k], d, m.second[k] + p);
            first[k] = hn::Sub(whole[k], second[k]);
        }
        hn::Store(hn::Add(residual(first, 7), residual(second, 7)), d, estimates + p);
    }
    return hn::GetLane(residual(whole, 15));
}

}  // namespace lobelia::bc6h::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::bc6h {

HWY_EXPORT(EstimateErrors);

float estimate_errors(const Texels& t, RegionMoments& m, float* estimates) {
    return HWY_DYNAMIC_DISPATCH(EstimateErrors)(t, m, estimates);
}

}  // namespace lobelia::bc6h
#endif
