// From states to pages: each texel's coefficients, its irradiance and error, and what is to be said of all of them.
#pragma once

#include "bake/baker.h"
#include "bake/gather/sites.h"

namespace lobelia {

/// Sums over texels; finish turns them into the statistics.
struct SolveTotals {
    std::size_t texels = 0, invalid = 0, buried = 0;
    double squared_error = 0, irradiance = 0, back_faces = 0;
    double codec_squared_error = 0;
    std::size_t readings = 0, negative = 0;
    double reading = 0, negative_part = 0;

    void add(const SolveTotals& other);
    void finish(BakeStatistics& statistics) const;
};

struct SolveOptions {
    const Codec* codec = nullptr;    ///< null: irradiance alone
    const Encoder* pages = nullptr;  ///< whose coefficients the pages hold: the codec's, or what it accumulates with
    std::uint32_t samples_per_pass = 16;
    bool in_tangent_frame = false;
};

/// Texel texels[k] of the map has its state at states[k * layout.floats()].
void solve_onto(std::span<Page> pages, const TexelMap& map, std::span<const std::uint32_t> texels,
                std::span<const float> states, const SiteLayout& layout, const SolveOptions& options,
                std::span<const Site> sites, const Atlas& atlas, SolveTotals& totals);

}  // namespace lobelia
