// Reading functions of a direction in blocks: the one loop behind radiance and linear irradiance.
#include "lobelia/evaluator.h"

#include "core/math/kernels.h"

namespace lobelia {

void evaluate_many(const FunctionSet& functions, std::span<const std::span<const Rgb>> c, DirectionView directions,
                   std::span<const MutableColourView> out) {
    assert(c.size() == out.size());
    std::vector<float> rows(functions.size() * k_block_size);
    for_each_part(directions, k_block_size, [&](DirectionView block, std::size_t begin) {
        functions.values(block, rows.data());
        for (std::size_t i = 0; i < c.size(); ++i) {
            assert(c[i].size() == functions.size() && out[i].size == directions.size);
            kernels::combine(rows.data(), functions.size(), c[i], out[i].part(begin, block.size));
        }
    });
}

void evaluate(const FunctionSet& functions, std::span<const Rgb> c, DirectionView directions, MutableColourView out) {
    evaluate_many(functions, std::span(&c, 1), directions, std::span(&out, 1));
}

void irradiance(const Evaluator& evaluator, std::span<const Rgb> c, DirectionView normals, MutableColourView out) {
    evaluator.signed_irradiance(c, normals, out);
    if (evaluator.negative() == Negative::clamped) clamp_negative(out);
}

void signed_irradiance_many(const Evaluator& evaluator, std::span<const std::span<const Rgb>> c, DirectionView normals,
                            std::span<const MutableColourView> out) {
    if (evaluator.weights()) return evaluate_many(*evaluator.weights(), c, normals, out);
    for (std::size_t i = 0; i < c.size(); ++i) evaluator.signed_irradiance(c[i], normals, out[i]);
}

void clamp_negative(MutableColourView colours) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < colours.size; ++i) colours.channel(k)[i] = std::max(colours.channel(k)[i], 0.0f);
}

}  // namespace lobelia
