// Coefficient vectors read in blocks.
#include "bake/solve/coefficient_blocks.h"

#include <algorithm>
#include <cassert>

namespace lobelia {
namespace {

/// out_j = sum_i c_ij f_i(direction j), where `rows` has room for the functions' values.
void sum(const FunctionSet& functions, std::span<const float> block, DirectionView directions, std::span<float> rows,
         MutableColourView out) {
    assert(block.size() == block_floats(functions.size()) && rows.size() == functions.size() * k_block_size);
    assert(directions.size <= k_block_size && out.size == directions.size);
    functions.values(directions, rows.data());
    for (std::size_t k = 0; k < 3; ++k) {
        float* const to = out.channel(k);
        std::fill(to, to + out.size, 0.0f);
        for (std::size_t i = 0; i < functions.size(); ++i) {
            const float* const c = block.data() + (3 * i + k) * k_block_size;
            const float* const row = rows.data() + i * k_block_size;
            for (std::size_t j = 0; j < out.size; ++j) to[j] += c[j] * row[j];
        }
    }
}

/// What is not linear in the coefficients is read from one vector at a time: read(c, direction, value).
template <class Read>
void read_one_by_one(std::span<const float> block, DirectionView directions, CoefficientVector& one, Read read,
                     MutableColourView out) {
    for (std::size_t j = 0; j < directions.size; ++j) {
        const auto at = [&](std::size_t plane) { return block[plane * k_block_size + j]; };
        for (std::size_t i = 0; i < one.c.size(); ++i) one.c[i] = {at(3 * i), at(3 * i + 1), at(3 * i + 2)};
        set_entry(one.direction.view(), 0, direction_at(directions, j));
        read(one.c, one.direction, one.value.view());
        set_entry(out, j, colour_at(one.value.view(), 0));
    }
}

}  // namespace

IrradianceReader::IrradianceReader(const Evaluator& evaluator, std::size_t coefficients)
    : evaluator_(&evaluator), rows_(coefficients * k_block_size), one_{std::vector<Rgb>(coefficients)} {
    assert(!evaluator.weights() || evaluator.weights()->size() == coefficients);
}

void IrradianceReader::read(std::span<const float> block, DirectionView normals, MutableColourView out) {
    if (const FunctionSet* weights = evaluator_->weights())
        sum(*weights, block, normals, rows_, out);
    else
        read_one_by_one(
            block, normals, one_,
            [&](std::span<const Rgb> c, DirectionView normal, MutableColourView value) {
                evaluator_->signed_irradiance(c, normal, value);
            },
            out);
    if (evaluator_->negative() == Negative::clamped) clamp_negative(out);
}

RadianceReader::RadianceReader(const Basis& basis, Negative negative)
    : basis_(&basis), negative_(negative), rows_(basis.size() * k_block_size), one_{std::vector<Rgb>(basis.size())} {}

void RadianceReader::read(std::span<const float> block, DirectionView directions, MutableColourView out) {
    if (const FunctionSet* functions = basis_->linear())
        sum(*functions, block, directions, rows_, out);
    else
        read_one_by_one(
            block, directions, one_,
            [&](std::span<const Rgb> c, DirectionView direction, MutableColourView value) {
                basis_->radiance(c, direction, value);
            },
            out);
    if (negative_ == Negative::clamped) clamp_negative(out);
}

}  // namespace lobelia
