// Functions of a direction, and evaluators: irradiance from coefficients, in blocks of directions or at one.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lobelia/sample.h"
#include "lobelia/shader_code.h"

namespace lobelia {

/// Number of directions per block: enough to amortise the virtual call, few enough for the rows of a dozen functions to
/// fit the first-level cache.
inline constexpr std::size_t k_block_size = 256;

/// `size()` real functions of a direction.
class FunctionSet {
  public:
    virtual ~FunctionSet() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Computes rows[i * k_block_size + j] = f_i(direction j), for block.size <= k_block_size directions. `rows` has
    /// size() * k_block_size floats; within a row, entries past block.size up to whole lanes may be overwritten.
    virtual void values(DirectionView block, float* rows) const = 0;
    /// Computes values[i] = f_i(direction). `values` has room for size() floats rounded up to whole lanes
    /// (round_up_to_lanes); those past size() may be overwritten. The default evaluates a block of one; overrides are
    /// faster.
    virtual void values_at(Vec3 direction, float* values) const;
};

/// Checks the arrays of an evaluation: the coefficients required, and a colour for each direction.
inline void check_evaluation(std::size_t required, std::span<const Rgb> c, const DirectionView& directions,
                             const MutableColourView& out, SourcePlace place = SourcePlace::here()) {
    check_equal("coefficients", c.size(), required, place);
    check_equal("colours for the directions", out.size, directions.size, place);
}

/// Computes out_j = sum_i c_i f_i(direction j): radiance for a linear basis, irradiance for a linear evaluator.
void evaluate(const FunctionSet& functions, std::span<const Rgb> c, DirectionView directions, MutableColourView out);
/// Evaluates one direction.
[[nodiscard]] Rgb evaluate(const FunctionSet& functions, std::span<const Rgb> c, Vec3 direction);

/// Evaluates many coefficient vectors at once; each function is computed only once per direction.
void evaluate_many(const FunctionSet& functions, std::span<const std::span<const Rgb>> c, DirectionView directions,
                   std::span<const MutableColourView> out);

/// Meaning of an evaluator's E. of_radiance: the integral of the radiance that the basis gives for the same
/// coefficients, within a stated error. of_its_own: the result of a model or a window, as in shaders.
enum class Reading { of_radiance, of_its_own };

/// The known accuracy of an evaluator, as its documentation and its tests state it.
struct Accuracy {
    std::string range;                       ///< valid range, such as "sharpness 1 to 1000"
    std::string error;                       ///< largest error in the range
    Reading reading = Reading::of_radiance;  ///< meaning of E, to which the error refers
    double furnace = 0;  ///< of_its_own: largest |E / pi - 1| that the evaluator adds for a constant radiance of 1
};

/// Treatment of radiance or irradiance below 0, which a fit may have: kept, or clamped to 0.
enum class Negative { kept, clamped };

/// Evaluates coefficients as irradiance E(n) [W/m^2] at unit normals n. Allocates nothing, except working memory of
/// each thread at its first call. Exceptions: "dering" and the evaluators of fitted lobes (sgfit*), which search.
class Evaluator {
  public:
    virtual ~Evaluator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual Accuracy accuracy() const = 0;
    /// Evaluates E without clamping negative values.
    virtual void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const = 0;
    /// Evaluates one normal. The default evaluates a block of one; overrides are faster.
    [[nodiscard]] virtual Rgb signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const;
    /// Returns the treatment of negative values of L and E.
    [[nodiscard]] virtual Negative negative() const { return Negative::kept; }
    /// Returns the weights e_i(n) with E = sum c_i e_i if the evaluator is linear in the coefficients; else null.
    [[nodiscard]] virtual const FunctionSet* weights() const { return nullptr; }
    /// Returns the shader code of irradiance(light, n). Errors: an evaluator that has none, with the reason.
    [[nodiscard]] virtual Result<ShaderCode> irradiance_code() const {
        return Error{"evaluator " + name() + " has no shader code"};
    }
};

/// An evaluator that is a vector of weights for each normal.
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

/// Evaluates irradiance as the evaluator defines it, clamped if it clamps.
void irradiance(const Evaluator& evaluator, std::span<const Rgb> c, DirectionView normals, MutableColourView out);
[[nodiscard]] Rgb irradiance(const Evaluator& evaluator, std::span<const Rgb> c, Vec3 normal);

/// Evaluates many coefficient vectors without clamping; a linear evaluator's weights are computed only once per normal.
void signed_irradiance_many(const Evaluator& evaluator, std::span<const std::span<const Rgb>> c, DirectionView normals,
                            std::span<const MutableColourView> out);

/// Clamps every channel at 0.
void clamp_negative(MutableColourView colours);
[[nodiscard]] constexpr Rgb clamp_negative(Rgb c) {
    return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

}  // namespace lobelia
