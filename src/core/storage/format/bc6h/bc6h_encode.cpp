// Encodes BC6H, lanes running over the texels of a block.
//
// A block is fitted by a line in each region, found as the principal axis and improved by least squares, in the space
// in which decoders interpolate: the bits of halves taken as numbers. Errors are those of square roots, between the
// error of values, which ignores the dark, and that of their logarithms, which ignores the bright. Channels are weighed
// by the square root of their mean magnitude, as derivatives of square roots ask for.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/half.h"
#include "core/storage/format/bc6h/bc6h_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/storage/format/bc6h/bc6h_encode.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::bc6h::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, k_texels>;
using I = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<I>;

HWY_INLINE V load(const float* lanes) { return hn::Load(D(), lanes); }
HWY_INLINE float sum_of(V v) { return hn::GetLane(hn::SumOfLanes(D(), v)); }

/// Bits of the half of |v|, v finite and at most 65504, as half_from_float() rounds.
HWY_INLINE VI half_bits(V magnitude) {
    const I i;
    const VI bits = hn::BitCast(i, magnitude);
    const VI rebiased = hn::Sub(bits, hn::Set(i, (127 - 15) << 23));
    const VI odd = hn::And(hn::ShiftRight<13>(rebiased), hn::Set(i, 1));
    const VI normal = hn::ShiftRight<13>(hn::Add(hn::Add(rebiased, hn::Set(i, 0xfff)), odd));
    const V half = hn::Set(D(), 0.5f);
    const VI subnormal = hn::Sub(hn::BitCast(i, hn::Add(magnitude, half)), hn::BitCast(i, half));
    const auto is_normal = hn::Ge(magnitude, hn::Set(D(), 0x1p-14f));
    return hn::IfThenElse(hn::RebindMask(i, is_normal), normal, subnormal);
}

/// The square root, with the sign of `signed_value`, of the half with these bits.
HWY_INLINE V root_of_half(VI bits, VI signed_value) {
    const D d;
    const I i;
    const VI shifted = hn::ShiftLeft<13>(bits);
    const VI rebiased = hn::Add(shifted, hn::Set(i, (127 - 15) << 23));
    const V least = hn::Sub(hn::BitCast(d, hn::Add(rebiased, hn::Set(i, 1 << 23))), hn::Set(d, 0x1p-14f));
    const auto tiny = hn::RebindMask(d, hn::Lt(shifted, hn::Set(i, 1 << 23)));
    const V magnitude = hn::IfThenElse(tiny, least, hn::BitCast(d, rebiased));
    return hn::CopySign(hn::Sqrt(magnitude), hn::BitCast(d, signed_value));
}

/// The rows of a texel: its parts of the moments and sums.
HWY_INLINE void fill_rows(Texels& t, float floor) {
    for (std::size_t i = 0; i < k_texels; ++i) {
        const float r = t.scaled[0][i], g = t.scaled[1][i], b = t.scaled[2][i];
        const float row[k_texels] = {1, r, g, b, r * r, r * g, r * b, g * g, g * b, b * b};
        std::copy_n(row, k_texels, t.moments[i]);
        float* sums = t.sums[i];
        for (std::size_t c = 0; c < 3; ++c, sums += k_sums) {
            const float w = t.root[c][i] * t.root[c][i] + floor, wx = w * t.wide[c][i];
            sums[0] = sums[1] = sums[2] = w;
            sums[3] = sums[4] = wx;
        }
        *sums = 0;
    }
}

template <Signedness sign>
void load_texels(const float* const* channels, std::size_t stride, Texels& t) {
    const D d;
    float mean[3], largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        alignas(64) float values[k_texels];
        for (std::size_t row = 0; row < 4; ++row) std::copy_n(channels[c] + row * stride, 4, values + row * 4);
        V total = hn::Zero(d), low = hn::Set(d, 1e9f), high = hn::Set(d, -1e9f);
        for (std::size_t i = 0; i < k_texels; i += hn::Lanes(d)) {
            const V lowest = sign == Signedness::signed_halves ? hn::Set(d, -k_largest_half) : hn::Zero(d);
            const V number = hn::IfThenElseZero(hn::Eq(load(values + i), load(values + i)), load(values + i));
            const V v = hn::Min(hn::Max(number, lowest), hn::Set(d, k_largest_half));
            const V magnitude = hn::Abs(v);
            const VI half = half_bits(magnitude);
            // The least number that decoders scale to this half.
            const float scale = sign == Signedness::signed_halves ? 32.0f / 31 : 64.0f / 31;
            const V wide = hn::CopySign(hn::Ceil(hn::Mul(hn::ConvertTo(d, half), hn::Set(d, scale))), v);
            hn::Store(wide, d, t.wide[c] + i);
            hn::Store(hn::CopySign(hn::Sqrt(magnitude), v), d, t.root[c] + i);
            total = hn::Add(total, magnitude);
            low = hn::Min(low, wide);
            high = hn::Max(high, wide);
        }
        mean[c] = sum_of(total) / k_texels;
        largest = std::max(largest, mean[c]);
        t.low[c] = hn::GetLane(hn::MinOfLanes(d, low));
        t.high[c] = hn::GetLane(hn::MaxOfLanes(d, high));
    }
    const float floor = largest * (1.0f / 256) + 1e-12f;
    for (std::size_t c = 0; c < 3; ++c) {
        t.channel_weight[c] = std::sqrt(mean[c] + floor);
        t.middle[c] = (t.low[c] + t.high[c]) / 2;
        for (std::size_t i = 0; i < k_texels; i += hn::Lanes(d)) {
            const V from_middle = hn::Sub(load(t.wide[c] + i), hn::Set(d, t.middle[c]));
            hn::Store(hn::Mul(from_middle, hn::Set(d, t.channel_weight[c])), d, t.scaled[c] + i);
        }
    }
    fill_rows(t, floor);
}

/// The principal axis of texels with these moments, as a unit vector, or zero where they are all alike; and their mean.
HWY_INLINE void principal_axis(const float* m, float* mean, float* axis) {
    const float n = m[Moment::count];
    for (std::size_t c = 0; c < 3; ++c) mean[c] = m[Moment::r + c] / n;
    float scatter[3][3];
    for (std::size_t a = 0, k = Moment::rr; a < 3; ++a)
        for (std::size_t b = a; b < 3; ++b, ++k) scatter[a][b] = scatter[b][a] = m[k] - n * mean[a] * mean[b];

    // Powers of the scatter, from its largest row.
    std::size_t start = scatter[1][1] > scatter[0][0] ? 1 : 0;
    if (scatter[2][2] > scatter[start][start]) start = 2;
    std::copy_n(scatter[start], 3, axis);
    for (int round = 0; round < 4; ++round) {
        const float size = 1 / std::max({std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2]), 1e-30f});
        const float x = axis[0] * size, y = axis[1] * size, z = axis[2] * size;
        for (std::size_t a = 0; a < 3; ++a) axis[a] = scatter[a][0] * x + scatter[a][1] * y + scatter[a][2] * z;
    }
    const float length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    for (std::size_t a = 0; a < 3; ++a) axis[a] = length > 0 ? axis[a] / length : 0;
}

/// The line through the texels whose member is 1: from the least to the largest projection on the principal axis.
HWY_INLINE void fit_line(const Texels& t, const float* region_moments, const float* member, std::array<float, 3>& from,
                         std::array<float, 3>& to) {
    const D d;
    float mean[3], axis[3];
    principal_axis(region_moments, mean, axis);
    V low = hn::Set(d, 1e30f), high = hn::Set(d, -1e30f);
    for (std::size_t i = 0; i < k_texels; i += hn::Lanes(d)) {
        V along = hn::Zero(d);
        for (std::size_t c = 0; c < 3; ++c)
            along = hn::MulAdd(hn::Sub(load(t.scaled[c] + i), hn::Set(d, mean[c])), hn::Set(d, axis[c]), along);
        const auto inside = hn::Gt(load(member + i), hn::Zero(d));
        low = hn::Min(low, hn::IfThenElse(inside, along, low));
        high = hn::Max(high, hn::IfThenElse(inside, along, high));
    }
    const float first = hn::GetLane(hn::MinOfLanes(d, low)), last = hn::GetLane(hn::MaxOfLanes(d, high));
    for (std::size_t c = 0; c < 3; ++c) {
        const float unscaled = 1 / t.channel_weight[c];
        from[c] = (mean[c] + first * axis[c]) * unscaled + t.middle[c];
        to[c] = (mean[c] + last * axis[c]) * unscaled + t.middle[c];
    }
}

/// Keeps endpoints within the range of the block.
HWY_INLINE void keep_within(const Texels& t, std::array<float, 3>& endpoint) {
    for (std::size_t c = 0; c < 3; ++c) endpoint[c] = std::clamp(endpoint[c], t.low[c], t.high[c]);
}

/// Square roots of all colours that a block can have: 16 of one region, or 8 of each.
struct Palette {
    alignas(64) float root[3][k_texels];
};

template <Signedness sign>
HWY_INLINE void fill_palette(const Quantised& q, Palette& palette) {
    const D d;
    const I di;
    const std::size_t regions = q.mode->regions;
    const std::int32_t* weights = k_weight_table.of[regions - 1];
    for (std::size_t c = 0; c < 3; ++c) {
        alignas(64) std::int32_t ends[2][k_texels];
        for (std::size_t i = 0; i < k_texels; ++i) {
            const std::size_t first = regions == 2 && i >= 8 ? 2 : 0;
            ends[0][i] = q.wide[first][c];
            ends[1][i] = q.wide[first + 1][c];
        }
        for (std::size_t i = 0; i < k_texels; i += hn::Lanes(d)) {
            const VI w = hn::Load(di, weights + i), a = hn::Load(di, ends[0] + i), b = hn::Load(di, ends[1] + i);
            const VI sum = hn::Add(hn::ShiftLeft<6>(a), hn::Mul(hn::Sub(b, a), w));
            const VI mixed = hn::ShiftRight<6>(hn::Add(sum, hn::Set(di, 32)));
            const VI half = sign == Signedness::signed_halves
                                ? hn::ShiftRight<5>(hn::Mul(hn::Abs(mixed), hn::Set(di, 31)))
                                : hn::ShiftRight<6>(hn::Mul(mixed, hn::Set(di, 31)));
            hn::Store(root_of_half(half, mixed), d, palette.root[c] + i);
        }
    }
}

/// Chooses the index of least error for each texel; those of anchors lack the highest bit.
template <Signedness sign>
HWY_INLINE void choose_indices(const Texels& t, Candidate& candidate) {
    const D d;
    const I di;
    const bool two = candidate.endpoints.mode->regions == 2;
    const std::int32_t entries = two ? 8 : 16;
    Palette palette;
    fill_palette<sign>(candidate.endpoints, palette);

    alignas(64) float forbidden[k_texels] = {};
    forbidden[0] = 1e30f;
    if (two) forbidden[k_anchor[candidate.partition]] = 1e30f;
    const float* member = k_partition_table.mask[candidate.partition];
    alignas(64) std::int32_t indices[k_texels];
    V total = hn::Zero(d);
    for (std::size_t i = 0; i < k_texels; i += hn::Lanes(d)) {
        const auto in_second = hn::Gt(load(member + i), hn::Zero(d));
        const V r = load(t.root[0] + i), g = load(t.root[1] + i), b = load(t.root[2] + i);
        V best = hn::Set(d, 1e30f);
        VI index = hn::Zero(di);
        for (std::int32_t e = 0; e < entries; ++e) {
            const auto difference = [&](V value, std::size_t c) {
                const V first = hn::Set(d, palette.root[c][e]);
                return hn::Sub(value,
                               two ? hn::IfThenElse(in_second, hn::Set(d, palette.root[c][e + 8]), first) : first);
            };
            const V dr = difference(r, 0), dg = difference(g, 1), db = difference(b, 2);
            V error = hn::MulAdd(dr, dr, hn::MulAdd(dg, dg, hn::Mul(db, db)));
            if (e >= entries / 2) error = hn::Add(error, load(forbidden + i));
            const auto better = hn::Lt(error, best);
            best = hn::Min(error, best);
            index = hn::IfThenElse(hn::RebindMask(di, better), hn::Set(di, e), index);
        }
        hn::Store(index, di, indices + i);
        total = hn::Add(total, best);
    }
    candidate.error = sum_of(total);
    for (std::size_t i = 0; i < k_texels; ++i) candidate.indices[i] = static_cast<std::uint8_t>(indices[i]);
}

/// Endpoints that are best, by weighted least squares, for the indices as they are.
HWY_INLINE void refine(const Texels& t, const Candidate& candidate, WideEndpoints& e) {
    const D d;
    const std::size_t regions = candidate.endpoints.mode->regions;
    const std::uint32_t second = regions == 2 ? k_second_region[candidate.partition] : 0;
    alignas(64) float sums[2][k_texels] = {};
    for (std::size_t i = 0; i < k_texels; ++i) {
        float* region = sums[second >> i & 1];
        const float* shares = k_share_table.of[regions - 1][candidate.indices[i]];
        for (std::size_t k = 0; k < k_texels; k += hn::Lanes(d))
            hn::Store(hn::MulAdd(load(t.sums[i] + k), load(shares + k), load(region + k)), d, region + k);
    }
    for (std::size_t r = 0; r < regions; ++r)
        for (std::size_t c = 0; c < 3; ++c) {
            const float* s = sums[r] + c * k_sums;
            const float determinant = s[0] * s[2] - s[1] * s[1];
            if (!(determinant > 1e-4f * s[0] * s[2])) continue;
            const float inverse = 1 / determinant;
            e[2 * r][c] = (s[2] * s[3] - s[1] * s[4]) * inverse;
            e[2 * r + 1][c] = (s[0] * s[4] - s[1] * s[3]) * inverse;
        }
}

/// Whether no texel is further off than the block's range in its widest channel, as a flat block would be at worst.
/// Endpoints of few bits may be, where a bright channel hardly varies and a dark one does.
template <Signedness sign>
HWY_INLINE bool stays_within(const Texels& t, const Candidate& candidate) {
    Palette palette;
    fill_palette<sign>(candidate.endpoints, palette);
    const std::uint32_t second = candidate.endpoints.mode->regions == 2 ? k_second_region[candidate.partition] : 0;
    const auto squared = [](float root) { return root * std::abs(root); };
    float range = 0, worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto [low, high] = std::minmax_element(t.root[c], t.root[c] + k_texels);
        range = std::max(range, squared(*high) - squared(*low));
        for (std::size_t i = 0; i < k_texels; ++i) {
            const std::size_t entry = candidate.indices[i] + (second >> i & 1) * 8;
            const float value = squared(t.root[c][i]);
            const float error = std::abs(squared(palette.root[c][entry]) - value);
            worst = std::max(worst, error - 0x1p-11f * std::abs(value));
        }
    }
    return worst <= range;
}

/// The number of the half that is nearest to the middle of the block's values.
template <Signedness sign>
std::array<int, 3> middle_of(const Texels& t) {
    std::array<int, 3> middle{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto [low, high] = std::minmax_element(t.root[c], t.root[c] + k_texels);
        const float value = (*low * std::abs(*low) + *high * std::abs(*high)) / 2;
        const int half = half_from_float(std::abs(value));
        // The least number that decoders scale to this half.
        const int scale = sign == Signedness::signed_halves ? 32 : 64;
        middle[c] = (half * scale + 30) / 31 * (value < 0 ? -1 : 1);
    }
    return middle;
}

/// Lines through one region, or through the two of a partition, to begin with.
HWY_INLINE WideEndpoints first_lines(const Texels& t, const RegionMoments& m, std::size_t regions,
                                     std::size_t partition) {
    WideEndpoints e{};
    const std::size_t anchors[2] = {0, k_anchor[partition]};
    for (std::size_t r = 0; r < regions; ++r) {
        alignas(64) float member[k_texels];
        for (std::size_t i = 0; i < k_texels; ++i)
            member[i] = regions == 1 || (k_second_region[partition] >> i & 1) == r ? 1.0f : 0.0f;
        float region[Moment::total];
        m.of(regions, r, partition, region);
        auto &from = e[2 * r], &to = e[2 * r + 1];
        fit_line(t, region, member, from, to);
        // Begin at the end that the anchor is nearer to: its index has no highest bit.
        float towards = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const float w = t.channel_weight[c] * t.channel_weight[c];
            towards += (t.wide[c][anchors[r]] - (from[c] + to[c]) / 2) * (to[c] - from[c]) * w;
        }
        if (towards > 0) std::swap(from, to);
    }
    return e;
}

/// Fits a block with one region, or with the two of a partition, and keeps the best of a few rounds.
template <Signedness sign>
void fit(const Texels& t, const RegionMoments& m, std::size_t regions, std::size_t partition, Candidate& best) {
    constexpr int rounds = 3;
    WideEndpoints e = first_lines(t, m, regions, partition);
    float last = std::numeric_limits<float>::max();
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < 2 * regions; ++i) keep_within(t, e[i]);
        Candidate candidate{quantised(e, regions, sign), partition, {}, 0};
        choose_indices<sign>(t, candidate);
        if (candidate.error < best.error) best = candidate;
        if (candidate.error >= 0.95f * last) break;
        last = candidate.error;
        if (round + 1 < rounds) refine(t, candidate, e);
    }
}

/// Fits one region, then the partitions that promise most, where they promise anything.
template <Signedness sign>
Candidate best_candidate(const Texels& t) {
    RegionMoments m;
    alignas(64) float estimates[k_partitions];
    float limit = estimate_errors(t, m, estimates);
    Candidate best;
    fit<sign>(t, m, 1, 0, best);
    constexpr int tried = 2;
    for (int k = 0; k < tried && best.error > 0; ++k) {
        const auto least = static_cast<std::size_t>(std::min_element(estimates, estimates + k_partitions) - estimates);
        if (!(estimates[least] < limit)) break;
        fit<sign>(t, m, 2, least, best);
        limit = std::min(limit, 1.25f * estimates[least]);
        estimates[least] = std::numeric_limits<float>::max();
    }
    return best;
}

template <Signedness sign>
void encode_block(const float* const* channels, std::size_t stride, std::byte* out) {
    Texels t;
    load_texels<sign>(channels, stride, t);
    Candidate best = best_candidate<sign>(t);
    if (!stays_within<sign>(t, best)) {
        best.endpoints = flat(middle_of<sign>(t));
        best.indices = {};
    }
    write_block(best.endpoints, best.partition, best.indices, out);
}

void EncodeBlocks(const float* const* channels, std::size_t stride, std::size_t blocks, Signedness sign,
                  std::byte* out) {
    for (std::size_t i = 0; i < blocks; ++i) {
        const float* corner[3] = {channels[0] + 4 * i, channels[1] + 4 * i, channels[2] + 4 * i};
        if (sign == Signedness::signed_halves)
            encode_block<Signedness::signed_halves>(corner, stride, out + i * k_block_bytes);
        else
            encode_block<Signedness::unsigned_halves>(corner, stride, out + i * k_block_bytes);
    }
}

}  // namespace lobelia::bc6h::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia::bc6h {

HWY_EXPORT(EncodeBlocks);

void encode_blocks(const float* const* channels, std::size_t stride, std::size_t blocks, Signedness sign,
                   std::byte* out) {
    HWY_DYNAMIC_DISPATCH(EncodeBlocks)(channels, stride, blocks, sign, out);
}

}  // namespace lobelia::bc6h
#endif
