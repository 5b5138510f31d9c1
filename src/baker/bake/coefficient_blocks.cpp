// Coefficient vectors read in blocks.
#include "baker/bake/coefficient_blocks.h"

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

}  // namespace

IrradianceReader::IrradianceReader(const Evaluator& evaluator, std::size_t coefficients)
    : evaluator_(&evaluator), rows_(coefficients * k_block_size), c_(coefficients) {
    assert(!evaluator.weights() || evaluator.weights()->size() == coefficients);
}

void IrradianceReader::read(std::span<const float> block, DirectionView normals, MutableColourView out) {
    if (const FunctionSet* weights = evaluator_->weights()) {
        sum(*weights, block, normals, rows_, out);
    } else {
        // Such an evaluator wants one vector of coefficients at a time.
        for (std::size_t j = 0; j < normals.size; ++j) {
            const auto at = [&](std::size_t plane) { return block[plane * k_block_size + j]; };
            for (std::size_t i = 0; i < c_.size(); ++i) c_[i] = {at(3 * i), at(3 * i + 1), at(3 * i + 2)};
            set_entry(normal_.view(), 0, direction_at(normals, j));
            evaluator_->signed_irradiance(c_, normal_, value_);
            set_entry(out, j, colour_at(value_.view(), 0));
        }
    }
    if (evaluator_->negative() == Negative::clamped) clamp_negative(out);
}

RadianceReader::RadianceReader(const Basis& basis, Negative negative)
    : basis_(&basis), negative_(negative), rows_(basis.size() * k_block_size) {}

void RadianceReader::read(std::span<const float> block, DirectionView directions, MutableColourView out) {
    sum(*basis_, block, directions, rows_, out);
    if (negative_ == Negative::clamped) clamp_negative(out);
}

}  // namespace lobelia
