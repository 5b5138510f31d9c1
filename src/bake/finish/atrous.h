// One pass of an a-trous filter ("with holes") over planes of a page: each value becomes its weighted mean with its
// eight neighbours a step away. Dammertz et al. 2010.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lobelia {

/// Half of a texel's neighbours; the other half has it as theirs. Binomial weights, beside the centre's 1/4.
struct AtrousTap {
    int x = 0, y = 0;
    float weight = 0;
};
inline constexpr std::array<AtrousTap, 4> k_atrous_taps = {
    AtrousTap{1, 0, 1.0f / 8}, {-1, 1, 1.0f / 16}, {0, 1, 1.0f / 8}, {1, 1, 1.0f / 16}};
inline constexpr float k_atrous_centre = 1.0f / 4;

/// weight[k][i] joins texel i and the one that tap k, `step` times as long, reaches from it; 0 where that is not to be
/// read or lies off the page.
struct AtrousWeights {
    std::size_t width = 0, height = 0;
    std::size_t step = 1;
    std::array<std::vector<float>, k_atrous_taps.size()> weight;
};

/// values: means. known_values: means of what is not NaN; NaN where all is. first_variances, later_variances: what
/// variance such a mean has. Independent errors add by the squares of their weights; after the first pass neighbours
/// have texels in common, and a full kernel leaves about half the variance along each axis instead of 3/8: an exponent
/// of 7/4 says so, and leaves a texel alone that has no neighbours.
enum class AtrousMean { values, known_values, first_variances, later_variances };

/// `from` and `to` have width * height values and are not the same.
void average(const AtrousWeights& weights, AtrousMean mean, const std::vector<float>& from, std::vector<float>& to);

}  // namespace lobelia
