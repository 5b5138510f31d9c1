// Reading functions of a direction in blocks: the one loop behind radiance and linear irradiance.
#include "lobelia/basis.h"

#include "lobelia/kernels.h"

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

}  // namespace lobelia
