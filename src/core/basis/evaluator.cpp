// Evaluation of functions of a direction, in blocks and one at a time: the one loop behind radiance and linear
// irradiance, for coefficients that all directions share and for coefficients of each place's own.
#include "lobelia/evaluator.h"

#include "core/math/kernels.h"
#include "core/math/scratch.h"
#include "lobelia/evaluate.h"

namespace lobelia {
namespace {

/// One direction and one colour as views, for the forms that take many.
struct OneDirection {
    Vec3 direction;
    Rgb colour;
    [[nodiscard]] DirectionView directions() const { return {{&direction.x, &direction.y, &direction.z}, 1}; }
    [[nodiscard]] MutableColourView colours() { return {{&colour.r, &colour.g, &colour.b}, 1}; }
};

/// Sets of at most this many functions, whole lanes of them, are evaluated at one direction on the stack.
constexpr std::size_t k_few = 128;

/// Evaluates places one by one, as evaluators that are not linear in the coefficients have to be: at(c, direction).
template <class At>
void one_by_one(CoefficientPointers c, DirectionView directions, MutableColourView out, const At& at) {
    const std::size_t count = c.size() / 3;
    check_equal("planes of coefficients", c.size(), 3 * count);
    check_equal("colours for the directions", out.size, directions.size);
    const Scratch memory(c.size());
    // Three consecutive floats are a colour.
    Rgb* const one = new (memory.data()) Rgb[count];
    for (std::size_t j = 0; j < directions.size; ++j) {
        for (std::size_t i = 0; i < count; ++i) one[i] = {c[3 * i][j], c[3 * i + 1][j], c[3 * i + 2][j]};
        set_entry(out, j, at(std::span<const Rgb>(one, count), direction_at(directions, j)));
    }
}

void evaluate_each(const FunctionSet& functions, CoefficientPointers c, DirectionView directions,
                   MutableColourView out) {
    check_equal("planes of coefficients", c.size(), 3 * functions.size());
    check_equal("colours for the directions", out.size, directions.size);
    const Scratch rows(functions.size() * k_block_size);
    for_each_part(directions, k_block_size, [&](DirectionView block, std::size_t begin) {
        functions.values(block, rows.data());
        kernels::combine_each(rows.data(), c, begin, out.part(begin, block.size));
    });
}

}  // namespace

void FunctionSet::values_at(Vec3 direction, float* values) const {
    const OneDirection one{direction, {}};
    const Scratch rows(size() * k_block_size);
    this->values(one.directions(), rows.data());
    for (std::size_t i = 0; i < size(); ++i) values[i] = rows.data()[i * k_block_size];
}

Rgb Evaluator::signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const {
    OneDirection one{normal, {}};
    signed_irradiance(c, one.directions(), one.colours());
    return one.colour;
}

Rgb Basis::radiance_at(std::span<const Rgb> c, Vec3 direction) const {
    OneDirection one{direction, {}};
    radiance(c, one.directions(), one.colours());
    return one.colour;
}

void evaluate_many(const FunctionSet& functions, std::span<const std::span<const Rgb>> c, DirectionView directions,
                   std::span<const MutableColourView> out) {
    check_equal("outputs for the coefficient vectors", out.size(), c.size());
    for (std::size_t i = 0; i < c.size(); ++i) check_evaluation(functions.size(), c[i], directions, out[i]);
    const Scratch rows(functions.size() * k_block_size);
    for_each_part(directions, k_block_size, [&](DirectionView block, std::size_t begin) {
        functions.values(block, rows.data());
        for (std::size_t i = 0; i < c.size(); ++i)
            kernels::combine(rows.data(), functions.size(), c[i], out[i].part(begin, block.size));
    });
}

void evaluate(const FunctionSet& functions, std::span<const Rgb> c, DirectionView directions, MutableColourView out) {
    evaluate_many(functions, std::span(&c, 1), directions, std::span(&out, 1));
}

Rgb evaluate(const FunctionSet& functions, std::span<const Rgb> c, Vec3 direction) {
    check_equal("coefficients", c.size(), functions.size());
    if (c.size() <= k_few) {
        alignas(64) float values[k_few];  // whole vectors in one cache line each
        functions.values_at(direction, values);
        return kernels::weighted_sum(values, c);
    }
    const Scratch values(round_up_to_lanes(c.size()));
    functions.values_at(direction, values.data());
    return kernels::weighted_sum(values.data(), c);
}

void irradiance(const Evaluator& evaluator, std::span<const Rgb> c, DirectionView normals, MutableColourView out) {
    evaluator.signed_irradiance(c, normals, out);
    if (evaluator.negative() == Negative::clamped) clamp_negative(out);
}

Rgb irradiance(const Evaluator& evaluator, std::span<const Rgb> c, Vec3 normal) {
    const Rgb e = evaluator.signed_irradiance_at(c, normal);
    return evaluator.negative() == Negative::clamped ? clamp_negative(e) : e;
}

void irradiance(const Evaluator& evaluator, CoefficientPointers c, DirectionView normals, MutableColourView out) {
    if (const FunctionSet* weights = evaluator.weights())
        evaluate_each(*weights, c, normals, out);
    else
        one_by_one(c, normals, out,
                   [&](std::span<const Rgb> one, Vec3 normal) { return evaluator.signed_irradiance_at(one, normal); });
    if (evaluator.negative() == Negative::clamped) clamp_negative(out);
}

void radiance(const Basis& basis, CoefficientPointers c, DirectionView directions, MutableColourView out) {
    if (const FunctionSet* functions = basis.linear())
        evaluate_each(*functions, c, directions, out);
    else
        one_by_one(c, directions, out,
                   [&](std::span<const Rgb> one, Vec3 direction) { return basis.radiance_at(one, direction); });
}

void signed_irradiance_many(const Evaluator& evaluator, std::span<const std::span<const Rgb>> c, DirectionView normals,
                            std::span<const MutableColourView> out) {
    if (evaluator.weights()) return evaluate_many(*evaluator.weights(), c, normals, out);
    check_equal("outputs for the coefficient vectors", out.size(), c.size());
    for (std::size_t i = 0; i < c.size(); ++i) evaluator.signed_irradiance(c[i], normals, out[i]);
}

void clamp_negative(MutableColourView colours) {
    for (std::size_t k = 0; k < 3; ++k) kernels::clamp_negative({colours.channel(k), colours.size});
}

}  // namespace lobelia
