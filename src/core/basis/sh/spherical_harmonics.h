// The basis of real spherical harmonics of degrees 0 to L on the sphere.
// Ramamoorthi and Hanrahan 2001; Sloan 2008.
#pragma once

#include "core/basis/sh/sh_irradiance.h"
#include "core/basis/sh/sh_shader.h"
#include "core/basis/sh/sh_specular.h"
#include "lobelia/bases.h"

namespace lobelia {

class SphericalHarmonics final : public LinearBasis {
  public:
    explicit SphericalHarmonics(std::size_t degree) : harmonics_(degree), ones_(degree + 1, 1.0f) {}

    /// sh1 to sh8. Null if the name is none of these.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return harmonics_.size(); }
    void values(DirectionView block, float* rows) const override { harmonics_.values(block, rows); }
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override {
        harmonics_.sum(c, directions, out);
    }
    void values_at(Vec3 direction, float* values) const override { harmonics_.values_at(direction, values); }
    [[nodiscard]] Rgb radiance_at(std::span<const Rgb> c, Vec3 direction) const override {
        return harmonics_.sum_at(c, ones_, direction);
    }
    [[nodiscard]] Result<ShaderCode> radiance_code() const override { return sh_shader::radiance(harmonics_.degree()); }
    [[nodiscard]] std::string name() const override;
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    [[nodiscard]] bool is_non_negative() const override { return false; }
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    [[nodiscard]] std::vector<std::string> evaluator_names() const override {
        return sh_evaluator_names(harmonics_.degree());
    }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override {
        return sh_evaluator(name, harmonics_.degree());
    }
    [[nodiscard]] std::vector<std::string> specular_names() const override { return sh_specular_names(); }
    [[nodiscard]] std::shared_ptr<const SpecularEvaluator> specular(std::string_view name) const override {
        return sh_specular(name, harmonics_.degree());
    }
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;
    [[nodiscard]] std::optional<std::size_t> harmonics_degree() const override { return harmonics_.degree(); }
    /// sqrt(2l + 1): by the addition theorem no Y_lm exceeds sqrt((2l + 1) / 4 pi), which Y_l0 reaches, and
    /// c_0 = sqrt(1 / 4 pi) times the integral of L.
    [[nodiscard]] std::vector<float> lead_bounds() const override;

  private:
    harmonics::Harmonics harmonics_;
    std::vector<float> ones_;  ///< factors of the bands
};

}  // namespace lobelia
