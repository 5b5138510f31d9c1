// Converts states to pages: coefficients, irradiance and error of each texel, and statistics over all.
#pragma once

#include "bake/gather/encoding.h"
#include "bake/place/atlas.h"
#include "lobelia/bake.h"

namespace lobelia {

/// Sums over texels; finish() turns them into statistics.
struct SolveTotals {
    std::size_t texels = 0, invalid = 0, buried = 0;
    double squared_error = 0, irradiance = 0, back_faces = 0;
    double codec_squared_error = 0;
    std::size_t evaluations = 0, negative = 0;
    double evaluated = 0, negative_part = 0;

    void add(const SolveTotals& other);
    void finish(BakeStatistics& statistics) const;
};

/// The texels to solve, in parallel arrays; texels[k] is an index into the map, and its state is the k-th in `states`.
struct SolveTexels {
    std::span<const std::uint32_t> texels;
    std::span<const Receiver> receivers;
    std::span<const float> states;
    StopFlag stop = {};  ///< asked for each texel; Stopped is thrown
};

/// Puts texels onto their pages and adds to the totals. The same bits for any number of threads.
void solve_onto(std::span<LightmapPage> pages, const Atlas& atlas, const TexelMap& map, const SolveTexels& solved,
                const BakeEncoding& encoding, std::uint32_t samples_per_pass, SolveTotals& totals);

}  // namespace lobelia
