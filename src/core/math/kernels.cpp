// The vectorised inner loops that every basis and encoder shares, compiled for each vector width by Highway.
#include "core/math/kernels.h"

#include <cstddef>
#include <type_traits>

#include "lobelia/basis.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/math/kernels.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using lobelia::HWY_NAMESPACE::D;
using lobelia::HWY_NAMESPACE::load;
using lobelia::HWY_NAMESPACE::store;
using lobelia::HWY_NAMESPACE::V;

/// Sum of all lanes.
HWY_INLINE float reduce(D d, V v) { return hn::GetLane(hn::SumOfLanes(d, v)); }

/// Samples whose flux (radiance times solid angle) stays in the first-level cache beside their directions.
constexpr std::size_t k_flux_part = 1024;

/// Adds to out[first ..) the irradiance of one part of the samples at `Count` normals, and to `opposite`, unless that
/// is null, the irradiance at the normals turned round.
template <std::size_t Count, class Opposite>
void add_irradiance(DirectionView d_s, const float (*flux)[k_flux_part], DirectionView normals, std::size_t first,
                    MutableColourView out, Opposite opposite) {
    constexpr bool both = !std::is_same_v<Opposite, std::nullptr_t>;
    const D d;
    V front[Count][3], back[Count][3], n[Count][3];
    for (std::size_t i = 0; i < Count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            front[i][k] = back[i][k] = hn::Zero(d);
            n[i][k] = hn::Set(d, normals.channel(k)[first + i]);
        }
    const auto add = [&](std::size_t j, V x, V y, V z) HWY_ATTR {
        const V colour[3] = {hn::Load(d, flux[0] + j), hn::Load(d, flux[1] + j), hn::Load(d, flux[2] + j)};
        for (std::size_t i = 0; i < Count; ++i) {
            const V cosine = hn::MulAdd(n[i][0], x, hn::MulAdd(n[i][1], y, hn::Mul(n[i][2], z)));
            const V towards = hn::Max(cosine, hn::Zero(d));
            for (std::size_t k = 0; k < 3; ++k) front[i][k] = hn::MulAdd(towards, colour[k], front[i][k]);
            if constexpr (both) {
                const V away = hn::Max(hn::Neg(cosine), hn::Zero(d));
                for (std::size_t k = 0; k < 3; ++k) back[i][k] = hn::MulAdd(away, colour[k], back[i][k]);
            }
        }
    };
    std::size_t j = 0;
    for (; j + hn::Lanes(d) <= d_s.size; j += hn::Lanes(d))
        add(j, hn::LoadU(d, d_s.channel(0) + j), hn::LoadU(d, d_s.channel(1) + j), hn::LoadU(d, d_s.channel(2) + j));
    if (j < d_s.size) {
        const auto rest = lobelia::HWY_NAMESPACE::load(d, d_s, j);
        add(j, rest.x, rest.y, rest.z);
    }
    for (std::size_t i = 0; i < Count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            out.channel(k)[first + i] += reduce(d, front[i][k]);
            if constexpr (both) opposite.channel(k)[first + i] += reduce(d, back[i][k]);
        }
}

template <std::size_t Count, class Opposite>
void irradiance_sum(SampleView samples, DirectionView normals, MutableColourView out, Opposite opposite) {
    const D d;
    for_each_part(samples, k_flux_part, [&](SampleView part, std::size_t) {
        // Multiply radiance by solid angle once, zero past the end.
        alignas(64) float flux[3][k_flux_part];
        for (std::size_t j = 0; j < part.size; j += hn::Lanes(d)) {
            const V omega = load(d, part.solid_angles(), j, part.size);
            for (std::size_t k = 0; k < 3; ++k)
                hn::Store(hn::Mul(omega, load(d, part.radiance().channel(k), j, part.size)), d, flux[k] + j);
        }

        // Visit several normals at a time: each loaded sample then serves several sums.
        std::size_t i = 0;
        for (; i + Count <= normals.size; i += Count)
            add_irradiance<Count>(part.directions(), flux, normals, i, out, opposite);
        for (; i < normals.size; ++i) add_irradiance<1>(part.directions(), flux, normals, i, out, opposite);
    });
}

void IrradianceSum(SampleView samples, DirectionView normals, MutableColourView out) {
    for (std::size_t k = 0; k < 3; ++k) std::fill_n(out.channel(k), out.size, 0.0f);
    irradiance_sum<4>(samples, normals, out, nullptr);
}

void IrradianceSums(SampleView samples, DirectionView normals, MutableColourView out, MutableColourView opposite) {
    for (std::size_t k = 0; k < 3; ++k) {
        std::fill_n(out.channel(k), out.size, 0.0f);
        std::fill_n(opposite.channel(k), opposite.size, 0.0f);
    }
    irradiance_sum<2>(samples, normals, out, opposite);
}

float AddMoments(const float* rows, std::size_t count, SampleView block, float* sums) {
    const D d;
    alignas(64) float flux[3][k_block_size];
    V total = hn::Zero(d);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const V omega = load(d, block.solid_angles(), j, block.size);
        total = hn::Add(total, omega);
        for (std::size_t k = 0; k < 3; ++k)
            hn::Store(hn::Mul(omega, load(d, block.radiance().channel(k), j, block.size)), d, flux[k] + j);
    }
    for (std::size_t i = 0; i < count; ++i) {
        const float* row = rows + i * k_block_size;
        V r = hn::Zero(d), g = r, b = r;
        for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
            const V w = load(d, row, j, block.size);
            r = hn::MulAdd(w, hn::Load(d, flux[0] + j), r);
            g = hn::MulAdd(w, hn::Load(d, flux[1] + j), g);
            b = hn::MulAdd(w, hn::Load(d, flux[2] + j), b);
        }
        sums[3 * i] += reduce(d, r);
        sums[3 * i + 1] += reduce(d, g);
        sums[3 * i + 2] += reduce(d, b);
    }
    return reduce(d, total);
}

/// Adds the products of one weighted row with `Count` rows to sums[0..Count).
template <std::size_t Count>
HWY_INLINE void add_products(D d, const float* weighted, const float* rows, std::size_t size, float* sums) {
    V sum[Count];
    for (std::size_t k = 0; k < Count; ++k) sum[k] = hn::Zero(d);
    for (std::size_t j = 0; j < size; j += hn::Lanes(d)) {
        const V w = hn::Load(d, weighted + j);
        for (std::size_t k = 0; k < Count; ++k)
            sum[k] = hn::MulAdd(w, load(d, rows + k * k_block_size, j, size), sum[k]);
    }
    for (std::size_t k = 0; k < Count; ++k) sums[k] += reduce(d, sum[k]);
}

void AddGram(const float* rows, std::size_t count, SampleView block, float* sums) {
    const D d;
    alignas(64) float weighted[k_block_size];
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
            const V omega = load(d, block.solid_angles(), j, block.size);
            const V row = load(d, rows + i * k_block_size, j, block.size);
            hn::Store(hn::Mul(omega, row), d, weighted + j);
        }
        std::size_t k = i;
        for (; k + 4 <= count; k += 4, sums += 4)
            add_products<4>(d, weighted, rows + k * k_block_size, block.size, sums);
        for (; k < count; ++k, ++sums) add_products<1>(d, weighted, rows + k * k_block_size, block.size, sums);
    }
}

void AddWeightedDirections(const float* row, SampleView block, float* sums) {
    const D d;
    V sum[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const V omega = load(d, block.solid_angles(), j, block.size);
        const V w = hn::Mul(omega, load(d, row, j, block.size));
        for (std::size_t k = 0; k < 3; ++k)
            sum[k] = hn::MulAdd(w, load(d, block.directions().channel(k), j, block.size), sum[k]);
        sum[3] = hn::Add(sum[3], w);
    }
    for (std::size_t k = 0; k < 4; ++k) sums[k] += reduce(d, sum[k]);
}

void Combine(const float* rows, std::size_t count, std::span<const Rgb> c, MutableColourView out) {
    const D d;
    for (std::size_t j = 0; j < out.size; j += hn::Lanes(d)) {
        V r = hn::Zero(d), g = r, b = r;
        for (std::size_t i = 0; i < count; ++i) {
            const V w = hn::LoadU(d, rows + i * k_block_size + j);
            r = hn::MulAdd(hn::Set(d, c[i].r), w, r);
            g = hn::MulAdd(hn::Set(d, c[i].g), w, g);
            b = hn::MulAdd(hn::Set(d, c[i].b), w, b);
        }
        store(d, r, out.channel(0), j, out.size);
        store(d, g, out.channel(1), j, out.size);
        store(d, b, out.channel(2), j, out.size);
    }
}

void CombineEach(const float* rows, std::span<const float* const> c, std::size_t begin, MutableColourView out) {
    const D d;
    for (std::size_t j = 0; j < out.size; j += hn::Lanes(d)) {
        V sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        for (std::size_t i = 0; i < c.size(); i += 3) {
            const V w = hn::LoadU(d, rows + i / 3 * k_block_size + j);
            for (std::size_t k = 0; k < 3; ++k) sum[k] = hn::MulAdd(load(d, c[i + k] + begin, j, out.size), w, sum[k]);
        }
        for (std::size_t k = 0; k < 3; ++k) store(d, sum[k], out.channel(k), j, out.size);
    }
}

void ClampNegative(std::span<float> values) {
    const D d;
    for (std::size_t j = 0; j < values.size(); j += hn::Lanes(d)) {
        const V v = load(d, values.data(), j, values.size());
        // A comparison, since the maximum of a NaN differs between machines: it stays one.
        store(d, hn::IfThenZeroElse(hn::Lt(v, hn::Zero(d)), v), values.data(), j, values.size());
    }
}

Rgb WeightedSum(const float* weights, std::span<const Rgb> c) {
    return lobelia::HWY_NAMESPACE::weighted_sum(weights, c.data(), c.size());
}

void TransformRows(const float* rows, std::size_t count, const float* matrix, std::size_t size, float* to) {
    const D d;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < size; j += hn::Lanes(d)) {
            V sum = hn::Zero(d);
            for (std::size_t k = 0; k < count; ++k)
                sum = hn::MulAdd(hn::Set(d, matrix[i * count + k]), hn::LoadU(d, rows + k * k_block_size + j), sum);
            hn::StoreU(sum, d, to + i * k_block_size + j);
        }
}

/// Runs through the samples in order: evaluates the estimate from all lobes, then lets `update(j, l, w, delta)` move
/// the group of lobes from l on by the error delta.
template <class Update>
HWY_INLINE void for_each_sample(const Sequential& s, ColourView radiance, const Update& update) {
    const D d;
    for (std::size_t j = 0; j < radiance.size; ++j) {
        const float* values = s.values + j * s.lanes;
        V est[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        for (std::size_t l = 0; l < s.lanes; l += hn::Lanes(d)) {
            const V w = hn::LoadU(d, values + l);
            for (std::size_t k = 0; k < 3; ++k) est[k] = hn::MulAdd(w, hn::LoadU(d, s.b[k] + l), est[k]);
        }
        V delta[3];
        for (std::size_t k = 0; k < 3; ++k)
            delta[k] = hn::Sub(hn::Set(d, radiance.channel(k)[j]), hn::SumOfLanes(d, est[k]));
        for (std::size_t l = 0; l < s.lanes; l += hn::Lanes(d)) update(j, l, hn::LoadU(d, values + l), delta);
    }
}

void RunningAverage(const Sequential& s, ColourView radiance, const float* steps) {
    const D d;
    const V lowest = hn::Set(d, s.lowest);
    for_each_sample(s, radiance, [&](std::size_t j, std::size_t l, V w, const V* delta) HWY_ATTR {
        const V share = hn::Mul(w, hn::Set(d, steps[j]));
        const V sum = hn::Add(hn::LoadU(d, s.per_lobe + l), share);
        hn::StoreU(sum, d, s.per_lobe + l);
        // A lobe that has seen nothing yet has nothing to learn from: 0 / 0 counts as 0.
        const V gain = hn::IfThenElseZero(hn::Gt(sum, hn::Zero(d)), hn::Div(share, sum));
        for (std::size_t k = 0; k < 3; ++k) {
            const V b = hn::MulAdd(delta[k], gain, hn::LoadU(d, s.b[k] + l));
            hn::StoreU(hn::Max(b, lowest), d, s.b[k] + l);
        }
    });
}

void Progressive(const Sequential& s, ColourView radiance, const float* steps, const float* mean_steps) {
    const D d;
    const V lowest = hn::Set(d, s.lowest);
    for_each_sample(s, radiance, [&](std::size_t j, std::size_t l, V w, const V* delta) HWY_ATTR {
        const V a = hn::Set(d, steps[j]);
        const V old_mean = hn::LoadU(d, s.per_lobe + l);
        const V mean = hn::MulAdd(hn::Sub(hn::Mul(w, w), old_mean), hn::Set(d, mean_steps[j]), old_mean);
        hn::StoreU(mean, d, s.per_lobe + l);
        const V denominator = hn::Max(mean, hn::LoadU(d, s.floor + l));
        const V gain = hn::IfThenElseZero(hn::Gt(denominator, hn::Zero(d)), hn::Div(w, denominator));
        for (std::size_t k = 0; k < 3; ++k) {
            const V b = hn::LoadU(d, s.b[k] + l);
            const V target = hn::Mul(hn::MulAdd(b, w, delta[k]), gain);
            hn::StoreU(hn::Max(hn::MulAdd(hn::Sub(target, b), a, b), lowest), d, s.b[k] + l);
        }
    });
}

void MatrixGain(const Sequential& s, ColourView radiance, const float* steps) {
    const D d;
    for_each_sample(s, radiance, [&](std::size_t j, std::size_t l, V, const V* delta) HWY_ATTR {
        const V gain = hn::Mul(hn::LoadU(d, s.gains + j * s.lanes + l), hn::Set(d, steps[j]));
        for (std::size_t k = 0; k < 3; ++k)
            hn::StoreU(hn::MulAdd(gain, delta[k], hn::LoadU(d, s.b[k] + l)), d, s.b[k] + l);
    });
}

}  // namespace lobelia::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::kernels {

HWY_EXPORT(IrradianceSum);
HWY_EXPORT(IrradianceSums);
HWY_EXPORT(AddMoments);
HWY_EXPORT(AddGram);
HWY_EXPORT(AddWeightedDirections);
HWY_EXPORT(Combine);
HWY_EXPORT(CombineEach);
HWY_EXPORT(ClampNegative);
HWY_EXPORT(WeightedSum);
HWY_EXPORT(TransformRows);
HWY_EXPORT(RunningAverage);
HWY_EXPORT(Progressive);
HWY_EXPORT(MatrixGain);

void irradiance_sum(SampleView samples, DirectionView normals, MutableColourView out) {
    HWY_DYNAMIC_DISPATCH(IrradianceSum)(samples, normals, out);
}
void irradiance_sums(SampleView samples, DirectionView normals, MutableColourView out, MutableColourView opposite) {
    HWY_DYNAMIC_DISPATCH(IrradianceSums)(samples, normals, out, opposite);
}
float add_moments(const float* rows, std::size_t count, SampleView block, float* sums) {
    return HWY_DYNAMIC_DISPATCH(AddMoments)(rows, count, block, sums);
}
void add_gram(const float* rows, std::size_t count, SampleView block, float* sums) {
    HWY_DYNAMIC_DISPATCH(AddGram)(rows, count, block, sums);
}
WeightedDirections weighted_directions(const float* row, SampleView block) {
    float sums[4] = {};
    HWY_DYNAMIC_DISPATCH(AddWeightedDirections)(row, block, sums);
    return {{sums[0], sums[1], sums[2]}, sums[3]};
}
void combine(const float* rows, std::size_t count, std::span<const Rgb> c, MutableColourView out) {
    HWY_DYNAMIC_DISPATCH(Combine)(rows, count, c, out);
}
void combine_each(const float* rows, std::span<const float* const> c, std::size_t begin, MutableColourView out) {
    HWY_DYNAMIC_DISPATCH(CombineEach)(rows, c, begin, out);
}
void clamp_negative(std::span<float> values) { HWY_DYNAMIC_DISPATCH(ClampNegative)(values); }
Rgb weighted_sum(const float* weights, std::span<const Rgb> c) { return HWY_DYNAMIC_DISPATCH(WeightedSum)(weights, c); }
void transform_rows(const float* rows, std::size_t count, const float* matrix, std::size_t size, float* to) {
    HWY_DYNAMIC_DISPATCH(TransformRows)(rows, count, matrix, size, to);
}
void running_average(const Sequential& s, ColourView radiance, const float* steps) {
    HWY_DYNAMIC_DISPATCH(RunningAverage)(s, radiance, steps);
}
void progressive(const Sequential& s, ColourView radiance, const float* steps, const float* mean_steps) {
    HWY_DYNAMIC_DISPATCH(Progressive)(s, radiance, steps, mean_steps);
}
void matrix_gain(const Sequential& s, ColourView radiance, const float* steps) {
    HWY_DYNAMIC_DISPATCH(MatrixGain)(s, radiance, steps);
}

}  // namespace lobelia::kernels
#endif
