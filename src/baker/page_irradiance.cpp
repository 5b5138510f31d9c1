// Irradiance of a whole page, read from its coefficients.
#include "baker/page_irradiance.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace lobelia {
namespace {

/// E at some consecutive texels through a linear evaluator: weights of all normals at once, then plane by plane.
void add_linear(const FunctionSet& weights, DirectionView normals, const Page& page, std::size_t begin,
                MutableColourView out) {
    std::vector<float> rows(weights.size() * k_block_size);
    weights.values(normals, rows.data());
    for (std::size_t i = 0; i < weights.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const float *row = rows.data() + i * k_block_size, *c = page.planes[3 * i + k].data() + begin;
            float* sum = out.channel(k);
            for (std::size_t j = 0; j < normals.size; ++j) sum[j] += c[j] * row[j];
        }
}

/// The same through any evaluator, texel by texel.
void add_one_by_one(const Evaluator& evaluator, DirectionView normals, const Page& page, std::size_t begin,
                    std::size_t coefficients, MutableColourView out) {
    std::vector<Rgb> c(coefficients);
    Directions normal(1);
    Colours value(1);
    for (std::size_t j = 0; j < normals.size; ++j) {
        for (std::size_t i = 0; i < coefficients; ++i)
            c[i] = {page.planes[3 * i][begin + j], page.planes[3 * i + 1][begin + j],
                    page.planes[3 * i + 2][begin + j]};
        set_entry(normal.view(), 0, direction_at(normals, j));
        evaluator.signed_irradiance(c, normal, value);
        set_entry(out, j, colour_at(value.view(), 0));
    }
}

}  // namespace

std::vector<Rgb> page_irradiance(const Page& page, const PageLayout& layout, std::span<const Vec3> normals, Frame frame,
                                 const Evaluator& evaluator) {
    assert(normals.size() == page.size() && page.planes.size() == layout.channels());
    assert(!evaluator.weights() || evaluator.weights()->size() == layout.coefficients);
    std::vector<Rgb> result(page.size());
    const auto read = [&](std::size_t begin, std::size_t end) {
        // Where nothing was baked, any direction will do.
        Directions directions(end - begin);
        const auto is_baked = [&](std::size_t i) { return !(normals[i] == Vec3{}); };
        for (std::size_t i = begin; i < end; ++i)
            set_entry(directions.view(), i - begin, frame == Frame::world && is_baked(i) ? normals[i] : Vec3{0, 0, 1});
        Colours values(end - begin);
        if (evaluator.weights())
            add_linear(*evaluator.weights(), directions, page, begin, values);
        else
            add_one_by_one(evaluator, directions, page, begin, layout.coefficients, values);
        if (evaluator.negative() == Negative::clamped) clamp_negative(values);
        for (std::size_t i = begin; i < end; ++i)
            if (is_baked(i)) result[i] = colour_at(values.view(), i - begin);
    };
    const std::size_t blocks = (page.size() + k_block_size - 1) / k_block_size;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
        read(block * k_block_size, std::min((block + 1) * k_block_size, page.size()));
    });
    return result;
}

}  // namespace lobelia
