// Functions of a direction, and evaluators: how coefficients become irradiance, in blocks of directions or at one.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lobelia/sample.h"

namespace lobelia {

/// Directions are handled in blocks of this many: enough to hide the virtual call, small enough that the rows of a
/// dozen functions stay in the first-level cache.
inline constexpr std::size_t k_block_size = 256;

/// `size()` real functions of a direction.
class FunctionSet {
  public:
    virtual ~FunctionSet() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// rows[i * k_block_size + j] = f_i(direction j), for block.size <= k_block_size directions. `rows` has
    /// size() * k_block_size floats; within a row, entries past block.size up to whole lanes may be overwritten.
    virtual void values(DirectionView block, float* rows) const = 0;
    /// values[i] = f_i(direction). `values` has room for size() floats rounded up to whole lanes (round_up_to_lanes);
    /// those past size() may be overwritten. This general form takes a block of one; overrides are quicker.
    virtual void values_at(Vec3 direction, float* values) const;
};

/// Checks the arrays of an evaluation: the coefficients required, and a colour for each direction.
inline void check_evaluation(std::size_t required, std::span<const Rgb> c, const DirectionView& directions,
                             const MutableColourView& out, SourcePlace place = SourcePlace::here()) {
    check_equal("coefficients", c.size(), required, place);
    check_equal("colours for the directions", out.size, directions.size, place);
}

/// out_j = sum_i c_i f_i(direction j): radiance for a linear basis, irradiance for a linear evaluator.
void evaluate(const FunctionSet& functions, std::span<const Rgb> c, DirectionView directions, MutableColourView out);
/// The same at one direction.
[[nodiscard]] Rgb evaluate(const FunctionSet& functions, std::span<const Rgb> c, Vec3 direction);

/// The same for many coefficient vectors at once; each function is computed only once per direction.
void evaluate_many(const FunctionSet& functions, std::span<const std::span<const Rgb>> c, DirectionView directions,
                   std::span<const MutableColourView> out);

/// of_radiance: E is the integral of the radiance that the basis gives for the same coefficients, within a stated
/// error. of_its_own: E is what shaders make of the coefficients, by a model or with a window.
enum class Reading { of_radiance, of_its_own };

/// The known accuracy of an evaluator, as its documentation and its tests state it.
struct Accuracy {
    std::string range;                       ///< where it is valid, such as "sharpness 1 to 1000"
    std::string error;                       ///< the largest error there
    Reading reading = Reading::of_radiance;  ///< and what it is an error of
    double furnace = 0;  ///< of_its_own: largest |E / pi - 1| that it adds where a constant radiance of 1 is read
};

/// Treatment of radiance or irradiance below 0, which no light has but a fit may have: it stays, or becomes 0.
enum class Negative { kept, clamped };

/// Evaluates coefficients as irradiance E(n) [W/m^2] at unit normals n. Neither form allocates memory, but for working
/// memory that each thread keeps after its first call.
class Evaluator {
  public:
    virtual ~Evaluator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Accuracy accuracy() const = 0;
    /// E as the coefficients give it; what is below 0 is still there.
    virtual void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const = 0;
    /// The same at one normal. This general form takes a block of one; overrides are quicker.
    [[nodiscard]] virtual Rgb signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const;
    /// What this evaluator does with negative values of L and E.
    [[nodiscard]] virtual Negative negative() const { return Negative::kept; }
    /// The weights e_i(n) with E = sum c_i e_i where the evaluator is linear in the coefficients; else null.
    [[nodiscard]] virtual const FunctionSet* weights() const { return nullptr; }
};

/// An evaluator that is a vector of weights at a normal.
class LinearEvaluator : public Evaluator, public FunctionSet {
  public:
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        evaluate(*this, c, normals, out);
    }
    [[nodiscard]] Rgb signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const override {
        return evaluate(*this, c, normal);
    }
    [[nodiscard]] const FunctionSet* weights() const final { return this; }
};

/// Irradiance as the evaluator defines it: signed, then clamped where it clamps.
void irradiance(const Evaluator& evaluator, std::span<const Rgb> c, DirectionView normals, MutableColourView out);
[[nodiscard]] Rgb irradiance(const Evaluator& evaluator, std::span<const Rgb> c, Vec3 normal);

/// Signed irradiance of many coefficient vectors; a linear evaluator's weights are computed only once per normal.
void signed_irradiance_many(const Evaluator& evaluator, std::span<const std::span<const Rgb>> c, DirectionView normals,
                            std::span<const MutableColourView> out);

/// Every channel below 0 becomes 0.
void clamp_negative(MutableColourView colours);
[[nodiscard]] constexpr Rgb clamp_negative(Rgb c) {
    return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

}  // namespace lobelia
