// The ambient cube as engines store it: six irradiances, found from degree-2 harmonics. McTaggart 2004.
#pragma once

#include "lobelia/basis.h"
#include "lobelia/result.h"

namespace lobelia {

/// E(n) = sum of n_i^2 c_i over the three sides that the normal faces; c >= 0, in the order +x, -x, +y, -y, +z, -z.
class AmbientCubeIrradiance final : public FittedBasis {
  public:
    explicit AmbientCubeIrradiance(const Rotation& cube_from_domain) : cube_from_domain_(cube_from_domain) {}
    /// ambient-cube-e. Null if the name is another.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return 6; }
    /// Evaluates radiance as E / pi in that direction, because the coefficients do not determine it.
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override;
    [[nodiscard]] std::shared_ptr<const LinearBasis> accumulated() const override;
    /// The least error of E over all normals with c >= 0.
    void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const override;
    [[nodiscard]] std::string name() const override { return "ambient-cube-e"; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"squares"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

  private:
    Rotation cube_from_domain_;
};

}  // namespace lobelia
