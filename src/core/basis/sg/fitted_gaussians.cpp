// Fitted lobes as a basis: how they are stored and read.
#include "core/basis/sg/fitted_gaussians.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/basis/sg/lobe_fit.h"
#include "core/basis/sg/sg_irradiance.h"
#include "core/basis/sg/sg_specular_shader.h"
#include "core/basis/sg/spherical_gaussians.h"

namespace lobelia {
namespace {

/// The sharpest lobe that evaluators are made for (bases.h).
constexpr double k_sharpest = 1e4;

/// Irradiance of the lobes by one of the formulae; constants are made for each set of coefficients.
class FittedIrradiance final : public Evaluator {
  public:
    FittedIrradiance(SgIrradiance kind, std::size_t coefficients) : kind_(kind), coefficients_(coefficients) {}
    [[nodiscard]] std::string name() const override { return SgIrradianceWeights(kind_, {}).name(); }
    [[nodiscard]] Accuracy accuracy() const override { return SgIrradianceWeights(kind_, {}).accuracy(); }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(coefficients_, c, normals, out);
        const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
        SgIrradianceWeights(kind_, lobes).signed_irradiance(amplitudes, normals, out);
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        return sg_shader::fitted_irradiance(kind_, coefficients_ / 2);
    }

  private:
    SgIrradiance kind_;
    std::size_t coefficients_;
};

/// Glossy reflection of the lobes, likewise.
class FittedSpecular final : public SpecularEvaluator {
  public:
    FittedSpecular(std::string_view name, std::size_t coefficients) : name_(name), coefficients_(coefficients) {}
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] Accuracy accuracy() const override { return make_sg_specular(name_, {})->accuracy(); }
    [[nodiscard]] Result<ShaderCode> reflected_code() const override {
        return sg_shader::fitted_reflected(*sg_specular_from_name(name_), coefficients_ / 2);
    }
    void reflected(std::span<const Rgb> c, const SpecularPoints& points, MutableColourView out) const override {
        check_specular(coefficients_, c, points, out);
        const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
        make_sg_specular(name_, lobes)->reflected(amplitudes, points, out);
    }

  private:
    std::string name_;
    std::size_t coefficients_;
};

}  // namespace

std::shared_ptr<const FittedBasis> fitted_gaussians(std::size_t count) {
    check_range("lobes", count, 1, k_most_fitted_lobes);
    return std::make_shared<FittedGaussians>(count, std::make_shared<OctahedralTexels>(k_lobe_fit_resolution));
}

Result<std::shared_ptr<const Basis>> FittedGaussians::from_name(std::string_view name) {
    constexpr std::string_view prefix = "sgfit";
    if (!name.starts_with(prefix)) return std::shared_ptr<const Basis>();
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(name.data() + prefix.size(), name.data() + name.size(), count);
    if (error == std::errc::invalid_argument || end != name.data() + name.size()) return std::shared_ptr<const Basis>();
    if (error != std::errc() || count < 1 || count > k_most_fitted_lobes)
        return Error{"basis \"" + std::string(name) + "\": the number of lobes must be 1 to 12"};
    return std::shared_ptr<const Basis>(
        std::make_shared<FittedGaussians>(count, std::make_shared<OctahedralTexels>(k_lobe_fit_resolution)));
}

std::vector<Meaning> FittedGaussians::meanings() const {
    std::vector<Meaning> result;
    for (std::size_t j = 0; j < count_; ++j) result.insert(result.end(), {Meaning::light, Meaning::shape});
    return result;
}

FittedGaussians::Lobes FittedGaussians::lobes(std::span<const Rgb> c) {
    Lobes result;
    for (std::size_t j = 0; j + 1 < c.size(); j += 2) {
        // In double precision no length of finite coefficients overflows.
        const double x = c[j + 1].r, y = c[j + 1].g, z = c[j + 1].b, length = std::hypot(x, y, z);
        if (!std::isfinite(length)) {
            constexpr float nan = std::numeric_limits<float>::quiet_NaN();
            result.lobes.push_back({});
            result.amplitudes.push_back({nan, nan, nan});
            continue;
        }
        const auto part = [&](double component) { return static_cast<float>(component / length); };
        const Vec3 axis = length > 0 ? Vec3{part(x), part(y), part(z)} : Vec3{0, 0, 1};
        result.lobes.push_back({axis, static_cast<float>(std::min(length, k_sharpest))});
        result.amplitudes.push_back(c[j]);
    }
    return result;
}

void FittedGaussians::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    check_equal("accumulated coefficients", accumulated.size(), texels_->size());
    check_equal("coefficients", c.size(), size());
    std::fill(c.begin(), c.end(), Rgb{});
    // Rotate from the map's frame to that of the domain.
    const Rotation& m = texels_->map_from_domain();
    const auto lobes = fit_lobes(accumulated, count_);
    for (std::size_t j = 0; j < lobes.size(); ++j) {
        const auto& [axis, sharpness] = lobes[j].lobe;
        const Vec3 v = (m[0] * axis.x + m[1] * axis.y + m[2] * axis.z) * sharpness;
        c[2 * j] = lobes[j].amplitude;
        c[2 * j + 1] = {v.x, v.y, v.z};
    }
}

void FittedGaussians::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    check_evaluation(size(), c, directions, out);
    const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
    evaluate(SphericalGaussians("", lobes, Domain::sphere), amplitudes, directions, out);
}

std::string FittedGaussians::description() const {
    return std::to_string(count_) + " spherical Gaussians with fitted axes and sharpness";
}

std::shared_ptr<const Evaluator> FittedGaussians::evaluator(std::string_view name) const {
    const auto names = evaluator_names();
    if (std::find(names.begin(), names.end(), name) == names.end()) return nullptr;
    return std::make_shared<FittedIrradiance>(*sg_irradiance_from_name(name), size());
}

std::shared_ptr<const SpecularEvaluator> FittedGaussians::specular(std::string_view name) const {
    return sg_specular_from_name(name) ? std::make_shared<FittedSpecular>(name, size()) : nullptr;
}

Basis::Rotated FittedGaussians::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    const Rotation& m = texels_->map_from_domain();
    const Rotation turned{rotate(r, m[0]), rotate(r, m[1]), rotate(r, m[2])};
    std::vector<Rgb> lobes(c.begin(), c.end());
    for (std::size_t j = 1; j < lobes.size(); j += 2) {
        const Vec3 v = rotate(r, {c[j].r, c[j].g, c[j].b});
        lobes[j] = {v.x, v.y, v.z};
    }
    return {
        std::make_shared<FittedGaussians>(count_, std::make_shared<OctahedralTexels>(k_lobe_fit_resolution, turned)),
        std::move(lobes)};
}

}  // namespace lobelia
