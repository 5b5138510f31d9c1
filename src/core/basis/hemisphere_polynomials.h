// The H-basis: polynomials that are orthonormal over the hemisphere, and the exact irradiance of what is cut off at the
// horizon. Habel and Wimmer 2010.
#pragma once

#include "lobelia/bases.h"

namespace lobelia {

/// Irradiance at a normal n of the radiances 1, y, z, x, xy and (x^2 - y^2) / 2, each 0 below the horizon z = 0, in
/// this order. With c = n_z and g the angle of n to z: pi/2 (1 + c), 2/3 (pi - g) n_y, 2/3 (sin g + (pi - g) c), 2/3
/// (pi - g) n_x, pi/8 n_x n_y, pi/16 (n_x^2 - n_y^2).
class HorizonIrradiance final : public FunctionSet {
  public:
    /// The first 4 or all 6.
    explicit HorizonIrradiance(std::size_t count) : count_(count) {}
    [[nodiscard]] std::size_t size() const override { return count_; }
    void values(DirectionView block, float* rows) const override;

  private:
    std::size_t count_;
};

class HemispherePolynomials final : public LinearBasis {
  public:
    /// 4 or 6 functions.
    explicit HemispherePolynomials(std::size_t count) : count_(count) {}
    /// h4, h6. Null if the name is neither.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return count_; }
    /// k_0, k_1 y, k_1 (2z - 1), k_1 x, k_2 xy, k_2 (x^2 - y^2) / 2.
    void values(DirectionView block, float* rows) const override;
    [[nodiscard]] std::string name() const override { return count_ == 4 ? "h4" : "h6"; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::hemisphere; }
    [[nodiscard]] bool is_non_negative() const override { return false; }
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    /// projected: E as a combination of the same polynomials, which needs no arc cosine. exact: the integral over what
    /// is above the horizon, at any normal.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"projected", "exact"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

    /// Factors of the polynomials: sqrt(1 / 2 pi), sqrt(3 / 2 pi), sqrt(15 / 2 pi).
    [[nodiscard]] static double factor(std::size_t degree) {
        return std::sqrt((degree == 0 ? 1 : degree == 1 ? 3 : 15) / (2 * k_pi));
    }

  private:
    std::size_t count_;
};

}  // namespace lobelia
