// Ambient dice: a smooth spline over the twelve vertices of an icosahedron, by hybrid cubic Bezier patches; and the
// form that spends its slopes on luminance alone. Iwanicki and Sloan 2017; Alfeld et al. 1996 (splines on spheres); Liu
// and Schumaker 1996 (hybrid patches).
#pragma once

#include "lobelia/bases.h"

namespace lobelia {

/// Coefficients 3v, 3v + 1, 3v + 2: value at vertex v and its slopes [1/rad] along two tangents. On each face the
/// radiance is a cubic in the spherical barycentric coordinates; its middle control point is a blend of three, one for
/// each edge, that make slopes meet across that edge. It is divided by the same with all values 1 and all slopes 0, so
/// that constants are exact (the published form is up to 5 % low between vertices).
class AmbientDice final : public LinearBasis {
  public:
    explicit AmbientDice(const Rotation& dice_from_domain) : dice_from_domain_(dice_from_domain) {}
    /// dice-bezier and dice-ycocg. Null if the name is neither.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return 36; }
    void values(DirectionView block, float* rows) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::string name() const override { return "dice-bezier"; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    [[nodiscard]] bool is_non_negative() const override { return false; }
    /// Computed by quadrature over the faces, to 1e-9.
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    /// convolution: by way of harmonics up to degree 8.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"convolution"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

    [[nodiscard]] const Rotation& dice_from_domain() const { return dice_from_domain_; }

  private:
    Rotation dice_from_domain_;
};

/// Luminance as in AmbientDice, chroma (Co, Cg) linear between the vertices: coefficients 0 to 11 are (Y, Co, Cg) at
/// the vertices; the 24 slopes of Y follow, three to a coefficient.
class AmbientDiceYCoCg final : public FittedBasis {
  public:
    explicit AmbientDiceYCoCg(const Rotation& dice_from_domain)
        : dice_(std::make_shared<AmbientDice>(dice_from_domain)) {}

    [[nodiscard]] std::size_t size() const override { return 20; }
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::shared_ptr<const LinearBasis> accumulated() const override { return dice_; }
    void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const override;
    [[nodiscard]] std::string name() const override { return "dice-ycocg"; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"convolution"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

  private:
    std::shared_ptr<const AmbientDice> dice_;
};

}  // namespace lobelia
