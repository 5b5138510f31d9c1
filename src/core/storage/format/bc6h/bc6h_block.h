// What the parts of the BC6H encoder share: tables for vector lanes, a block's texels, candidates.
#pragma once

#include <limits>

#include "core/storage/format/bc6h/bc6h_write.h"

namespace lobelia::bc6h {

/// Partitions as rows of floats: member[texel][partition] is 1 in the second region.
struct PartitionTable {
    alignas(64) float member[k_texels][k_partitions] = {};
    alignas(64) float mask[k_partitions][k_texels] = {};  ///< the same, texels side by side
    constexpr PartitionTable() {
        for (std::size_t p = 0; p < k_partitions; ++p)
            for (std::size_t i = 0; i < k_texels; ++i)
                if (k_second_region[p] >> i & 1) member[i][p] = mask[p][i] = 1;
    }
};
inline constexpr PartitionTable k_partition_table;

/// Shares of the second endpoint: 16 entries, or 8 for each region.
struct WeightTable {
    alignas(64) std::int32_t of[2][k_texels] = {};
    constexpr WeightTable() {
        for (std::size_t i = 0; i < 16; ++i) of[0][i] = k_weights4[i];
        for (std::size_t i = 0; i < 16; ++i) of[1][i] = k_weights3[i % 8];
    }
};
inline constexpr WeightTable k_weight_table;

/// Sums over texels that a line follows from: their number, sums of the channels and of their products.
struct Moment {
    enum : std::size_t { count, r, g, b, rr, rg, rb, gg, gb, bb, total };
};
/// Sums that least squares follow from, five for each channel: w a a, w a b, w b b, w a x, w b x.
constexpr std::size_t k_sums = 5;

/// What an index stands for in those sums: rows of a a, a b, b b, a, b, three times over.
struct ShareTable {
    alignas(64) float of[2][k_texels][k_texels] = {};
    constexpr ShareTable() {
        for (std::size_t kind = 0; kind < 2; ++kind)
            for (std::size_t i = 0; i < 16; ++i) {
                const float b = static_cast<float>(kind == 0 ? k_weights4[i] : k_weights3[i % 8]) / 64, a = 1 - b;
                const float shares[k_sums] = {a * a, a * b, b * b, a, b};
                for (std::size_t k = 0; k < 3 * k_sums; ++k) of[kind][i][k] = shares[k % k_sums];
            }
    }
};
inline constexpr ShareTable k_share_table;

/// A block's texels. `wide` is where decoders interpolate, `root` where errors are measured.
struct Texels {
    alignas(64) float wide[3][k_texels];
    alignas(64) float root[3][k_texels];
    alignas(64) float scaled[3][k_texels];          ///< wide, from the middle, times the channel's weight
    alignas(64) float moments[k_texels][k_texels];  ///< a row for each texel, of its parts of the moments
    alignas(64) float sums[k_texels][k_texels];     ///< and of w, w, w, w x, w x for each channel, w its magnitude
    float channel_weight[3], middle[3];
    float low[3], high[3];  ///< range of wide
};

/// The moments of both regions of every partition, and of whole blocks.
struct RegionMoments {
    alignas(64) float whole[k_texels];
    alignas(64) float second[Moment::total][k_partitions];

    /// Those of one region of a partition, or of the whole.
    void of(std::size_t regions, std::size_t region, std::size_t partition, float* out) const {
        for (std::size_t k = 0; k < Moment::total; ++k)
            out[k] = regions == 1 ? whole[k] : region == 1 ? second[k][partition] : whole[k] - second[k][partition];
    }
};

/// A candidate: endpoints, the indices that suit them best, and the squared error that remains.
struct Candidate {
    Quantised endpoints;
    std::size_t partition = 0;
    std::array<std::uint8_t, k_texels> indices{};
    float error = std::numeric_limits<float>::max();
};

/// Sums the moments of whole blocks and of all second regions, estimates the error that the best lines leave for every
/// partition, and returns that of one line (Highway, chosen for the machine at run time).
[[nodiscard]] float estimate_errors(const Texels& t, RegionMoments& m, float* estimates);

}  // namespace lobelia::bc6h
