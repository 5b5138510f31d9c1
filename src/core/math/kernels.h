// The vectorised inner loops that every basis and encoder shares (Highway, chosen for the machine at run time).
// "Rows" are K x k_block_size tables of function values, as FunctionSet::values fills them.
#pragma once

#include <cstddef>
#include <span>

#include "lobelia/sample.h"

namespace lobelia::kernels {

/// out_j = sum_s L_s omega_s max(0, n_j . d_s).
void irradiance_sum(SampleView samples, DirectionView normals, MutableColourView out);

/// The same, and at the normals turned round too: opposite_j is the irradiance at -n_j.
void irradiance_sums(SampleView samples, DirectionView normals, MutableColourView out, MutableColourView opposite);

/// sums[3 i + c] += sum_j omega_j row_i[j] v_c[j], for `count` rows; returns sum_j omega_j.
float add_moments(const float* rows, std::size_t count, SampleView block, float* sums);

/// sums (upper triangle, row by row) += sum_j omega_j row_i[j] row_k[j].
void add_gram(const float* rows, std::size_t count, SampleView block, float* sums);

/// out_j = sum_i c_i row_i[j].
void combine(const float* rows, std::size_t count, std::span<const Rgb> c, MutableColourView out);

/// The same where every place has coefficients of its own: channel k of c_i for entry j is c[3 i + k][begin + j].
void combine_each(const float* rows, std::span<const float* const> c, std::size_t begin, MutableColourView out);

/// v_j = max(v_j, 0).
void clamp_negative(std::span<float> values);

/// sum_i weights_i c_i.
[[nodiscard]] Rgb weighted_sum(const float* weights, std::span<const Rgb> c);

/// to_i = sum_k matrix[i * count + k] row_k, for whole rows of `size` entries rounded up to lanes.
void transform_rows(const float* rows, std::size_t count, const float* matrix, std::size_t size, float* to);

/// sum_j omega_j row[j] d_j, and sum_j omega_j row[j].
struct WeightedDirections {
    Vec3 first;
    float sum = 0;
};
WeightedDirections weighted_directions(const float* row, SampleView block);

/// One pass of a sequential encoder over a block, lanes running over the lobes. All arrays over lobes have `lanes`
/// entries, a multiple of k_lanes; sample j's function values are values[j * lanes ..], zero past the last lobe.
struct Sequential {
    std::size_t lanes = 0;
    float* b[3] = {};               ///< the coefficients, one array per channel
    const float* values = nullptr;  ///< function values
    const float* gains = nullptr;   ///< matrix gain: G^-1 values, laid out as `values`
    float* per_lobe = nullptr;      ///< running average: sum of weights; progressive: running mean of B_i^2
    const float* floor = nullptr;   ///< progressive: least denominator S_i, positive past the last lobe
    float lowest = 0;               ///< coefficients are clamped to at least this
};

/// Steps: the share of each sample, step[j]. b += step value (v - est) / per_lobe after per_lobe += step value.
void running_average(const Sequential& s, ColourView radiance, const float* steps);
/// m += (w^2 - m) mean_step; b += ((v - est + b w) w / max(m, floor) - b) step.
void progressive(const Sequential& s, ColourView radiance, const float* steps, const float* mean_steps);
/// b += step gain (v - est).
void matrix_gain(const Sequential& s, ColourView radiance, const float* steps);

}  // namespace lobelia::kernels
