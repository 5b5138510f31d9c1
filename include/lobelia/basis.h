// Bases: the meaning of coefficients. Linear ones are a sum of functions; fitted ones are evaluated otherwise, and are
// found from a linear one.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>

#include "lobelia/evaluator.h"

namespace lobelia {

/// A symmetric K x K matrix, row by row, and so on: small dense tables in double precision.
using Matrix = std::vector<double>;

class LinearBasis;
class FittedBasis;
class SpecularEvaluator;  // lobelia/specular.h

/// light: a coefficient that grows in proportion to the radiance. shape: a direction, a sharpness, which does not.
enum class Meaning { light, shape };

/// What a list of colours means as radiance over the sphere or the hemisphere.
class Basis {
  public:
    virtual ~Basis() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    [[nodiscard]] virtual std::string description() const = 0;
    [[nodiscard]] virtual Domain domain() const = 0;
    /// Number of coefficients, one colour (three floats) each.
    [[nodiscard]] virtual std::size_t size() const = 0;
    /// What each coefficient is.
    [[nodiscard]] virtual std::vector<Meaning> meanings() const { return std::vector(size(), Meaning::light); }
    /// L(w) at each direction as the coefficients give it; what is below 0 is still there.
    virtual void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const = 0;
    /// The same in one direction. This general form takes a block of one; overrides are quicker.
    [[nodiscard]] virtual Rgb radiance_at(std::span<const Rgb> c, Vec3 direction) const;
    /// This basis as what it is, a sum of functions or fitted from one: one of the two is not null.
    [[nodiscard]] virtual const LinearBasis* linear() const { return nullptr; }
    [[nodiscard]] virtual const FittedBasis* fitted() const { return nullptr; }

    /// Names of the evaluators of irradiance for this basis, the most accurate one last, and one of them (null if
    /// unknown).
    [[nodiscard]] virtual std::vector<std::string> evaluator_names() const = 0;
    [[nodiscard]] virtual std::shared_ptr<const Evaluator> evaluator(std::string_view name) const = 0;
    /// Names of the basis's own specular evaluators, the most accurate one last, and one of them (null if unknown).
    /// Sampling works for every basis besides: make_specular.
    [[nodiscard]] virtual std::vector<std::string> specular_names() const { return {}; }
    [[nodiscard]] virtual std::shared_ptr<const SpecularEvaluator> specular(std::string_view name) const;

    /// The same radiance seen in a rotated frame, L'(R w) = L(w): a basis and coefficients that give it exactly.
    struct Rotated {
        std::shared_ptr<const Basis> basis;
        std::vector<Rgb> c;
    };
    /// For the hemisphere, `r` turns about z.
    [[nodiscard]] virtual Rotated rotated(const Rotation& r, std::span<const Rgb> c) const = 0;

    /// The degree of the spherical harmonics that the coefficients belong to, where they are such: orthonormal, real,
    /// all-plus, from degree 0 on.
    [[nodiscard]] virtual std::optional<std::size_t> harmonics_degree() const { return std::nullopt; }

    // Traits that storages make use of.
    /// Whether each coefficient is a colour, so that its chroma may be kept more coarsely than its luma.
    [[nodiscard]] virtual bool has_colours() const {
        const auto meaning_of = meanings();
        return std::count(meaning_of.begin(), meaning_of.end(), Meaning::light) == std::ssize(meaning_of);
    }
    /// Bounds b_i with |c_i| <= b_i c_0, channel by channel, for the coefficients of any light that is >= 0; empty
    /// where the first coefficient bounds nothing. b_0 = 1.
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
    /// Whether every B_i >= 0, so that coefficients >= 0 give a radiance >= 0 everywhere.
    [[nodiscard]] virtual bool is_non_negative() const = 0;
    /// G_ij = integral of B_i B_j over the domain [sr].
    [[nodiscard]] virtual Matrix gram() const = 0;
    /// Integral of each B_i over the domain [sr].
    [[nodiscard]] virtual std::vector<double> integrals() const = 0;
};

/// A basis whose numbers are found from the coefficients of a linear one, which is what encoders accumulate: ambient
/// and highlight, lobes with axes of their own. Evaluation need not be linear.
class FittedBasis : public Basis {
  public:
    [[nodiscard]] const FittedBasis* fitted() const final { return this; }
    /// The linear basis, over the same domain, fine enough for fit() to find all that it needs in it.
    [[nodiscard]] virtual std::shared_ptr<const LinearBasis> accumulated() const = 0;
    /// Coefficients `c` of this basis from coefficients of the accumulated one. No samples, all 0, gives all 0.
    virtual void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const = 0;
    /// Whether nearly the same input gives nearly the same coefficients; a search may end in another minimum.
    [[nodiscard]] virtual bool is_continuous() const { return true; }
};

[[nodiscard]] inline std::shared_ptr<const SpecularEvaluator> Basis::specular(std::string_view) const {
    return nullptr;
}

/// The same object, or null where it is not linear.
[[nodiscard]] inline std::shared_ptr<const LinearBasis> as_linear(const std::shared_ptr<const Basis>& basis) {
    return {basis, basis->linear()};
}

}  // namespace lobelia
