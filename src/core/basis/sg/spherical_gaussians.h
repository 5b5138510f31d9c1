// The basis of spherical Gaussians on fixed axes: names, lobe sets, Gram matrices.
// Wang et al. 2009; Vogel 1979; Pettineo 2016 (the hemispherical sets).
#pragma once

#include <mutex>

#include "core/basis/sg/sg_shader.h"
#include "core/basis/sg/sg_specular.h"
#include "lobelia/bases.h"

namespace lobelia {

/// `count` axes spread over the sphere along a Vogel spiral, sharpness count / 2.
[[nodiscard]] std::vector<Lobe> vogel_sphere(std::size_t count);

/// The upper half of a spiral of 2 `count` points; sharpness ln(0.65) count / (c - 1.0001), c the least cosine between
/// the first axis and its half vector with another.
[[nodiscard]] std::vector<Lobe> spiral_hemisphere(std::size_t count);

/// row[j] = G(direction j) of a lobe, for a whole block as FunctionSet::values.
void gaussian_row(const Lobe& lobe, DirectionView block, float* row);

class SphericalGaussians final : public LinearBasis {
  public:
    SphericalGaussians(std::string name, std::vector<Lobe> lobes, Domain domain);

    /// sg<N>: the Vogel sphere of N lobes. sg<N>a: and an ambient lobe. sg<N>h: the hemispherical set. Then @S: of
    /// sharpness S instead of the set's own, 0.01 to 10000. N is 1 to 512. sg{x y z s;...}, sgh{...}: these lobes over
    /// the sphere or the hemisphere. Null if the name is none of these.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] const std::vector<Lobe>& lobes() const { return lobes_; }

    [[nodiscard]] std::size_t size() const override { return lobes_.size(); }
    void values(DirectionView block, float* rows) const override;
    void values_at(Vec3 direction, float* values) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override { return sg_shader::radiance(lobes_); }
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return domain_; }
    [[nodiscard]] bool is_non_negative() const override { return true; }
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    [[nodiscard]] std::vector<std::string> evaluator_names() const override;
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] std::vector<std::string> specular_names() const override { return sg_specular_names(); }
    [[nodiscard]] std::shared_ptr<const SpecularEvaluator> specular(std::string_view name) const override {
        return make_sg_specular(name, lobes_);
    }
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

  private:
    std::string name_;
    std::vector<Lobe> lobes_;
    Domain domain_;
    Planes<4> rows_;  ///< the lobes again: x, y, z, sharpness
    mutable std::once_flag gram_once_;
    mutable Matrix gram_;  ///< computed at the first call: on the hemisphere it takes K^2 / 2 quadratures
};

}  // namespace lobelia
