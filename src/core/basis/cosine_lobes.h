// Bases of clamped cosine powers about fixed axes: the ambient cube, radiosity normal mapping, the ambient dice with
// spherical radial basis functions. McTaggart 2004; Mitchell et al. 2006; Iwanicki and Sloan 2017.
#pragma once

#include <array>

#include "lobelia/bases.h"

namespace lobelia {

/// B_i(w) = a c^2 + b c^4, c = max(0, w . p_i).
struct CosineLobe {
    float square = 1, fourth = 0;
};

/// Integral of max(0, w . p)^m max(0, w . q)^n over the domain [sr], for unit p and q; m + n is even.
[[nodiscard]] double clamped_power_product(Domain domain, std::array<Vec3, 2> axes, std::array<int, 2> powers);
/// Irradiance over pi of max(0, w . p)^2 and of max(0, w . p)^4 at a normal n, c = p . n, as polynomials in c from
/// power 0 on: (1 + c)^2 / 8, and 1/16 + c/6 + c^2/8 - c^4/48.
inline constexpr std::array<double, 5> k_square_irradiance = {1.0 / 8, 1.0 / 4, 1.0 / 8, 0, 0};
inline constexpr std::array<double, 5> k_fourth_irradiance = {1.0 / 16, 1.0 / 6, 1.0 / 8, 0, -1.0 / 48};

class CosineLobes final : public LinearBasis {
  public:
    /// Parameters of one basis of the family.
    struct Kind {
        std::string_view name, description;
        Domain domain;
        CosineLobe lobe;
        double squares_furnace;  ///< Accuracy::furnace of `squares`
    };
    CosineLobes(const Kind& kind, std::vector<Vec3> axes) : kind_(kind), axes_(std::move(axes)) {}

    /// ambient-cube, hl2, dice-srbf. Null if the name is none of these.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return axes_.size(); }
    void values(DirectionView block, float* rows) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::string name() const override { return std::string(kind_.name); }
    [[nodiscard]] std::string description() const override { return std::string(kind_.description); }
    [[nodiscard]] Domain domain() const override { return kind_.domain; }
    [[nodiscard]] bool is_non_negative() const override { return true; }
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    /// squares (cube and hl2): E at the axes, interpolated by squared cosines as shaders do. exact: of whole lobes.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override;
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

  private:
    const Kind& kind_;
    std::vector<Vec3> axes_;
};

}  // namespace lobelia
