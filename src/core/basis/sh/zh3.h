// ZH3: degree-1 harmonics and the part of degree 2 that is zonal about the axis of degree 1. Roughton et al. 2024.
#pragma once

#include "lobelia/bases.h"
#include "lobelia/basis.h"

namespace lobelia {

/// Coefficients 0 to 3 are degree-1 harmonics, 4 is z of each channel: L(w) = degree 1 + z Y_20(axis . w). The axis is
/// that of degree 1, of the luminance for all channels (shared), or of each channel alone.
class Zh3 final : public FittedBasis {
  public:
    using Axis = ZonalAxis;
    explicit Zh3(Axis axis) : axis_(axis) {}
    /// zh3 and zh3-rgb. Null if the name is neither.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return 5; }
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::shared_ptr<const LinearBasis> accumulated() const override;
    /// The least error of irradiance, band by band A_l^2 |L_l' - L_l|^2, over the axis and all else; the mean is kept.
    void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const override;
    [[nodiscard]] std::string name() const override { return axis_ == Axis::shared ? "zh3" : "zh3-rgb"; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    /// convolution: negative L and E are read as 0; convolution-signed: as it is.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override {
        return {"convolution", "convolution-signed"};
    }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;
    /// Returns the bounds of harmonics if each channel's vector is only projected; a shared axis may lengthen the
    /// vectors.
    [[nodiscard]] std::vector<float> lead_bounds() const override;

  private:
    Axis axis_;
};

}  // namespace lobelia
