// Lightmaps whose irradiance is linear in the normal, E(n) = e0 + e . n, in the forms in which they are stored:
// degree-1 harmonics that are dark below the surface, harmonics that keep the irradiance at the surface's normal, and
// one colour with one or three directions. Ramamoorthi and Hanrahan 2001; Roughton et al. 2024 (the exact normal);
// Geomerics 2014 (Enlighten's directional maps).
#pragma once

#include <array>

#include "lobelia/basis.h"
#include "lobelia/result.h"

namespace lobelia {

/// Moments of the light that the fits below need, over the hemisphere: radiance against 1, z, and against the
/// irradiances of x, y and z (see HorizonIrradiance), the first moments of E over the upper normals.
class NormalMoments final : public LinearBasis {
  public:
    [[nodiscard]] std::size_t size() const override { return 5; }
    void values(DirectionView block, float* rows) const override;
    [[nodiscard]] std::string name() const override { return "normal-moments"; }
    [[nodiscard]] std::string description() const override {
        return "moments from which directional lightmaps are fitted";
    }
    [[nodiscard]] Domain domain() const override { return Domain::hemisphere; }
    [[nodiscard]] bool is_non_negative() const override { return false; }
    [[nodiscard]] Matrix gram() const override;
    [[nodiscard]] std::vector<double> integrals() const override;
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view) const override { return nullptr; }
    /// Only for turns by 0: it is no basis that one stores.
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;
};

/// Irradiance of one channel, E(n) = constant + slope . n [W/m^2].
struct LinearIrradiance {
    double constant = 0;
    std::array<double, 3> slope{};
};

class DirectionalLightmap final : public FittedBasis {
  public:
    /// sh1h: c = the integrals of L Y over the hemisphere, degree 1: as if the surface were black below its horizon.
    /// irradz: degree-1 coefficients whose E is exact at the surface's normal and nearest to the reference, by least
    /// squares, at the others above. enlighten: E at the surface's normal, and D with E(n) = E (1 + n . D) / (1 + D_z),
    /// |D| <= 1, of the luminance. enlighten_rgb: E, then D_x, D_y, D_z with a component for each channel.
    enum class Kind { sh1h, irradz, enlighten, enlighten_rgb };
    explicit DirectionalLightmap(Kind kind) : kind_(kind) {}
    [[nodiscard]] static Result<std::shared_ptr<const Basis>> from_name(std::string_view name);

    [[nodiscard]] std::size_t size() const override { return kind_ == Kind::enlighten ? 2 : 4; }
    [[nodiscard]] std::vector<Meaning> meanings() const override;
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const override;
    [[nodiscard]] std::shared_ptr<const LinearBasis> accumulated() const override;
    void fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const override;
    [[nodiscard]] std::string name() const override;
    [[nodiscard]] std::string description() const override;
    [[nodiscard]] Domain domain() const override { return Domain::hemisphere; }
    /// linear: E(n) = e0 + e . n; negative L and E are read as 0. linear-signed: as it is.
    [[nodiscard]] std::vector<std::string> evaluator_names() const override { return {"linear", "linear-signed"}; }
    [[nodiscard]] std::shared_ptr<const Evaluator> evaluator(std::string_view name) const override;
    [[nodiscard]] Rotated rotated(const Rotation& r, std::span<const Rgb> c) const override;
    /// Returns bounds for sh1h, valid for any light that is >= 0; none for the others, which can have directions
    /// without a mean, or store ratios already.
    [[nodiscard]] std::vector<float> lead_bounds() const override;

    [[nodiscard]] Result<ShaderCode> radiance_code() const override { return code("w", 1 / k_pi, 3 / (2 * k_pi)); }
    /// The shader code of constant e0 + slope e . direction, of the E(n) = e0 + e . n that the coefficients have.
    [[nodiscard]] ShaderCode code(const std::string& direction, double constant, double slope) const;

    /// E of each channel as the coefficients have it.
    [[nodiscard]] std::array<LinearIrradiance, 3> irradiance(std::span<const Rgb> c) const;

  private:
    Kind kind_;
};

}  // namespace lobelia
