// Bases: the meaning of coefficients. Linear ones are a sum of functions; fitted ones are evaluated in another way, and
// are derived from a linear one.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>

#include "lobelia/evaluator.h"

namespace lobelia {

/// A symmetric K x K matrix, stored row by row: small dense tables in double precision.
using Matrix = std::vector<double>;

class LinearBasis;
class FittedBasis;
class SpecularEvaluator;  // lobelia/specular.h

/// light: a coefficient proportional to the radiance. shape: one that is not, such as a direction or a sharpness.
enum class Meaning { light, shape };

/// A basis: evaluates coefficients as radiance over the sphere or the hemisphere.
class Basis {
  public:
    virtual ~Basis() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string description() const = 0;
    [[nodiscard]] virtual Domain domain() const = 0;
    /// Number of coefficients, one colour (three floats) each.
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// Returns the meaning of each coefficient.
    [[nodiscard]] virtual std::vector<Meaning> meanings() const { return std::vector(size(), Meaning::light); }
    /// Evaluates L(w) at each direction, without clamping negative values.
    virtual void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const = 0;
    /// Evaluates one direction. The default evaluates a block of one; overrides are faster.
    [[nodiscard]] virtual Rgb radiance_at(std::span<const Rgb> c, Vec3 direction) const;
    /// Returns the shader code of radiance(light, w). Errors: a basis that has none, with the reason.
    [[nodiscard]] virtual Result<ShaderCode> radiance_code() const {
        return Error{"basis " + name() + " has no shader code"};
    }
    /// Returns this basis as a sum of functions, or as one fitted from a linear basis: exactly one of the two is not
    /// null.
    [[nodiscard]] virtual const LinearBasis* linear() const { return nullptr; }
    [[nodiscard]] virtual const FittedBasis* fitted() const { return nullptr; }

    /// Names of the irradiance evaluators, the most accurate one last, and the evaluator of a name (null if unknown).
    [[nodiscard]] virtual std::vector<std::string> evaluator_names() const = 0;
    [[nodiscard]] virtual std::shared_ptr<const Evaluator> evaluator(std::string_view name) const = 0;
    /// Names of the basis's own specular evaluators, the most accurate one last, and the evaluator of a name (null if
    /// unknown). make_specular adds sampling, which works for every basis.
    [[nodiscard]] virtual std::vector<std::string> specular_names() const { return {}; }
    [[nodiscard]] virtual std::shared_ptr<const SpecularEvaluator> specular(std::string_view name) const;

    /// A basis and coefficients that give exactly the same radiance in a rotated frame, L'(R w) = L(w).
    struct Rotated {
        std::shared_ptr<const Basis> basis;
        std::vector<Rgb> c;
    };
    /// Rotates coefficients. Precondition for the hemisphere: `r` rotates about z.
    [[nodiscard]] virtual Rotated rotated(const Rotation& r, std::span<const Rgb> c) const = 0;

    /// Returns the degree of the spherical harmonics that the coefficients belong to; none if they are not orthonormal
    /// real harmonics with all-plus signs from degree 0 on.
    [[nodiscard]] virtual std::optional<std::size_t> harmonics_degree() const { return std::nullopt; }

    // Traits that storages use.
    /// Returns whether each coefficient is a colour, so that its chroma may be stored at lower precision than its luma.
    [[nodiscard]] virtual bool has_colours() const {
        const auto meaning_of = meanings();
        return std::count(meaning_of.begin(), meaning_of.end(), Meaning::light) == std::ssize(meaning_of);
    }
    /// Returns bounds b_i with |c_i| <= b_i c_0 per channel, for the coefficients of any light that is >= 0; b_0 = 1.
    /// Empty if the first coefficient bounds nothing.
    [[nodiscard]] virtual std::vector<float> lead_bounds() const { return {}; }
};

/// Radiance L(w) = sum_i c_i B_i(w).
class LinearBasis : public Basis, public FunctionSet {
  public:
    [[nodiscard]] std::size_t size() const override = 0;
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override {
        evaluate(*this, c, directions, out);
    }
    [[nodiscard]] Rgb radiance_at(std::span<const Rgb> c, Vec3 direction) const override {
        return evaluate(*this, c, direction);
    }
    [[nodiscard]] const LinearBasis* linear() const final { return this; }
    /// Returns whether every B_i >= 0, so that coefficients >= 0 give a radiance >= 0 everywhere.
    [[nodiscard]] virtual bool is_non_negative() const = 0;
    /// Returns G_ij, the integral of B_i B_j over the domain [sr].
    [[nodiscard]] virtual Matrix gram() const = 0;
    /// Returns the integral of each B_i over the domain [sr].
    [[nodiscard]] virtual std::vector<double> integrals() const = 0;
};

/// A basis whose coefficients are computed from those of a linear one, which encoders accumulate: ambient and
/// highlight, lobes with fitted axes. Evaluation need not be linear.
class FittedBasis : public Basis {
  public:
    [[nodiscard]] const FittedBasis* fitted() const final { return this; }
    /// Returns the linear basis, over the same domain, fine enough for all that fit() needs.
    [[nodiscard]] virtual std::shared_ptr<const LinearBasis> accumulated() const = 0;
    /// Computes the coefficients `c` of this basis from those of the accumulated one. All 0 (no samples) gives all 0.
    virtual void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const = 0;
    /// Returns whether nearly equal input gives nearly equal coefficients; not so for a search that may end in another
    /// minimum.
    [[nodiscard]] virtual bool is_continuous() const { return true; }
};

[[nodiscard]] inline std::shared_ptr<const SpecularEvaluator> Basis::specular(std::string_view) const {
    return nullptr;
}

/// Returns the same object, or null if it is not linear.
[[nodiscard]] inline std::shared_ptr<const LinearBasis> as_linear(const std::shared_ptr<const Basis>& basis) {
    return {basis, basis->linear()};
}

}  // namespace lobelia
