// Irradiance from spherical Gaussians: every published approximation, three new ones, and the exact series.
// Wang et al. 2009; Pettineo 2016 (parts 3 and 4; the fit by S. Hill); Meder and Bruederlin 2018; Tokuyoshi 2024.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/math/gaussian.h"
#include "lobelia/basis.h"

namespace lobelia {

/// inner_product: the clamped cosine as SG(2.133) * 1.17. punctual: all energy from the axis. hill: Hill's fit.
/// meder: Meder-Bruederlin. tokuyoshi: Tokuyoshi 2024. odd_exact, odd_exact_2: the odd part I L(lambda) c / 2 is exact,
/// the even part a square root of an exponential (forms N1, N2). polynomial: the odd part exact, the even part a
/// minimax cubic in c^2 made for each lobe's sharpness. exact: the zonal series.
enum class SgIrradiance { inner_product, punctual, hill, meder, tokuyoshi, odd_exact, odd_exact_2, polynomial, exact };

struct SgIrradianceInfo {
    SgIrradiance kind;
    std::string_view name;
    std::string_view range;  ///< sharpness for which `error` holds
    double low, high;        ///< the same as numbers
    double error;            ///< largest |error| / I there, I the lobe's integral; tested in float32
};
[[nodiscard]] std::span<const SgIrradianceInfo> sg_irradiance_list();
[[nodiscard]] std::optional<SgIrradiance> sg_irradiance_from_name(std::string_view name);

/// Sets of at most this many lobes are evaluated at one normal on the stack; whole lanes of them.
inline constexpr std::size_t k_few_lobes = 128;

/// The irradiance of each unit lobe of a set at a normal. Ambient lobes (sharpness 0) give pi in every kind.
class SgIrradianceWeights final : public LinearEvaluator {
  public:
    SgIrradianceWeights(SgIrradiance kind, std::vector<gaussian::Lobe> lobes);
    [[nodiscard]] std::string name() const override;
    [[nodiscard]] Accuracy accuracy() const override;
    [[nodiscard]] std::size_t size() const override { return lobes_.size(); }
    void values(DirectionView block, float* rows) const override;
    void values_at(Vec3 normal, float* values) const override;
    [[nodiscard]] Rgb signed_irradiance_at(std::span<const Rgb> c, Vec3 normal) const override;
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override;

  private:
    SgIrradiance kind_;
    std::vector<Lobe> lobes_;
    std::vector<std::vector<float>> constants_;  ///< of each lobe, in the order of the kind's formula
    // The same for lanes that run over lobes, as values_at reads them: rows x, y, z, then the constants.
    std::vector<float> lobe_rows_;  ///< row k of lobe i at [k * lobe_stride_ + i]
    std::size_t constant_count_ = 0, lobe_stride_ = 0;
    std::vector<std::size_t> ambient_;  ///< lobes of sharpness 0
};

/// Minimax fit of the even part of E / I by q_0 + q_1 x + q_2 x^2 + ..., x = c^2, `count` coefficients.
[[nodiscard]] std::vector<double> fit_even_part(double sharpness, std::size_t count);

/// Irradiance of one unit lobe by `kind` at each cosine between normal and axis, in float32.
[[nodiscard]] std::vector<float> sg_irradiance(SgIrradiance kind, double sharpness, std::span<const float> cosines);

}  // namespace lobelia
