// One pass of an a-trous filter ("with holes") over planes of a page: each value becomes its weighted mean with its
// eight neighbours a step away. Dammertz et al. 2010.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lobelia {

/// Half of a texel's eight neighbours; symmetry gives the other half. Binomial weights; the centre's is 1/4.
struct AtrousTap {
    int x = 0, y = 0;
    float weight = 0;
};
inline constexpr std::array<AtrousTap, 4> k_atrous_taps = {
    AtrousTap{1, 0, 1.0f / 8}, {-1, 1, 1.0f / 16}, {0, 1, 1.0f / 8}, {1, 1, 1.0f / 16}};
inline constexpr float k_atrous_centre = 1.0f / 4;

/// weight[k][i] joins texel i and its neighbour at tap k times `step`; 0 if they must not be mixed or the neighbour
/// lies off the page.
struct AtrousWeights {
    std::size_t width = 0, height = 0;
    std::size_t step = 1;
    std::array<std::vector<float>, k_atrous_taps.size()> weight;
};

/// Kinds of averages. values: means. known_values: means of the values that are not NaN; NaN if all are.
/// first_variances, later_variances: variances of such means. Variances of independent errors are weighted by squared
/// weights; after the first pass neighbours share texels, and a full kernel leaves about half the variance along each
/// axis instead of 3/8: an exponent of 7/4 reproduces that, and leaves texels without neighbours unchanged.
enum class AtrousMean { values, known_values, first_variances, later_variances };

/// Averages the plane `from` into `to`. Both have width * height values, and must be different vectors.
void average(const AtrousWeights& weights, AtrousMean mean, const std::vector<float>& from, std::vector<float>& to);

}  // namespace lobelia
