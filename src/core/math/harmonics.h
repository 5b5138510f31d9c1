// Real spherical harmonics as mathematics: values, the clamped cosine, rotation. All-plus signs, index l^2 + l + m.
// Sloan 2008 and 2013; Ramamoorthi and Hanrahan 2001.
#pragma once

#include <span>
#include <vector>

#include "lobelia/basis.h"

namespace lobelia::harmonics {

/// Number of coefficients of degree `degree`: (degree + 1)^2.
[[nodiscard]] constexpr std::size_t coefficient_count(std::size_t degree) { return (degree + 1) * (degree + 1); }

/// Coefficient A_l of the clamped cosine max(0, cos): pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, ...
[[nodiscard]] double clamped_cosine(std::size_t l);

/// The orthonormal real harmonics of degrees 0 .. degree, by recurrence in float32.
class Harmonics final : public FunctionSet {
  public:
    explicit Harmonics(std::size_t degree);
    [[nodiscard]] std::size_t degree() const { return degree_; }
    [[nodiscard]] std::size_t size() const override { return coefficient_count(degree_); }
    void values(DirectionView block, float* rows) const override;
    /// out_j = sum_i c_i Y_i(direction j), as evaluate() does, but without a table; bands of zeros cost little.
    void sum(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const;
    void values_at(Vec3 direction, float* values) const override;
    /// sum_l f_l sum_m c_lm Y_lm at one direction, f the degree() + 1 factors of the bands.
    [[nodiscard]] Rgb sum_at(std::span<const Rgb> c, std::span<const float> band_factors, Vec3 direction) const;

  private:
    std::size_t degree_;
    std::vector<float> table_;  ///< recurrence constants, see harmonics.cpp
};

/// The same in double precision for one direction: the oracle, and what tables are computed from.
[[nodiscard]] std::vector<double> values(std::size_t degree, double x, double y, double z);

/// Coefficients of L'(R w) = L(w). Degree 1 turns the vector, degree 2 the quadratic form, higher bands go through an
/// exact quadrature of their rotation matrix. `c` has coefficient_count(degree) entries.
[[nodiscard]] std::vector<Rgb> rotated(const Rotation& r, std::span<const Rgb> c);

/// The (2l + 1) x (2l + 1) matrix, row by row, that takes band l of L to band l of L'.
[[nodiscard]] Matrix rotation_matrix(const Rotation& r, std::size_t l);

}  // namespace lobelia::harmonics
