// Spherical Gaussians whose axes and sharpness are fitted to the light, too, from octahedral texels: variable
// projection (Golub and Pereyra 1973), amplitudes by non-negative least squares within.
#pragma once

#include "core/basis/octahedral.h"
#include "core/basis/sg/sg_shader.h"
#include "core/basis/sg/sg_specular.h"

namespace lobelia {

/// N lobes in 2 N coefficients: amplitude, and axis times sharpness. L(w) = sum of a_i exp(v_i . w - |v_i|), a_i >= 0,
/// the lobes in order of their light. 6 N floats.
class FittedGaussians final : public FittedBasis {
  public:
    FittedGaussians(std::size_t count, std::shared_ptr<const OctahedralTexels> texels)
        : count_(count), texels_(std::move(texels)) {}
    /// sgfit<N>, N 1 to 12. Null if the name is of another family.
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return 2 * count_; }
    [[nodiscard]] std::vector<Meaning> meanings() const override;
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] Result<ShaderCode> radiance_code() const override { return sg_shader::fitted_radiance(count_); }
    [[nodiscard]] std::shared_ptr<const LinearBasis> accumulated() const override { return texels_; }
    void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const override;
    [[nodiscard]] bool is_continuous() const override { return false; }
    [[nodiscard]] std::string name() const override { return "sgfit" + std::to_string(count_); }
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::sphere; }
    /// Returns the evaluators of SgIrradiance that are valid for any sharpness.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override {
        return {"tokuyoshi", "odd-exact", "odd-exact-2", "exact"};
    }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] std::vector<std::string> specular_names() const override { return sg_specular_names(); }
    [[nodiscard]] std::shared_ptr<const SpecularEvaluator> specular(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;

    /// The lobes that coefficients stand for, and their amplitudes. A sharpness above 10000 counts as that; a lobe
    /// whose axis or sharpness is not finite has an amplitude of NaN.
    struct Lobes {
        std::vector<gaussian::Lobe> lobes;
        std::vector<Rgb> amplitudes;
    };
    [[nodiscard]] static Lobes lobes(std::span<const Rgb> c);

  private:
    std::size_t count_;
    std::shared_ptr<const OctahedralTexels> texels_;
};

}  // namespace lobelia
