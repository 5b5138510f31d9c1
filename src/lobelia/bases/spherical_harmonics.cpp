// Spherical harmonics as a basis, and their irradiance by convolution with the clamped cosine.
#include "lobelia/bases/spherical_harmonics.h"

namespace lobelia {
namespace {

constexpr std::size_t k_highest_degree = 8;

/// E(n) = sum A_l L_lm Y_lm(n): exact for the radiance that the coefficients describe.
class ConvolvedHarmonics final : public LinearEvaluator {
  public:
    ConvolvedHarmonics(std::size_t degree, Negative negative) : harmonics_(degree), negative_(negative) {}
    [[nodiscard]] std::string name() const override {
        return negative_ == Negative::clamped ? "convolution" : "convolution-signed";
    }
    [[nodiscard]] Negative negative() const override { return negative_; }
    [[nodiscard]] Accuracy accuracy() const override {
        return {"every degree", "1e-6 of the largest E (float32 rounding)"};
    }
    [[nodiscard]] std::size_t size() const override { return harmonics_.size(); }
    void values(DirectionView block, float* rows) const override {
        harmonics_.values(block, rows);
        for (std::size_t l = 0; l <= harmonics_.degree(); ++l) {
            const auto scale = static_cast<float>(harmonics::clamped_cosine(l));
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
                for (std::size_t j = 0; j < block.size; ++j) rows[i * k_block_size + j] *= scale;
        }
    }

  private:
    harmonics::Harmonics harmonics_;
    Negative negative_;
};

}  // namespace

Result<std::shared_ptr<const Basis>> SphericalHarmonics::from_name(std::string_view name) {
    if (name.size() != 3 || !name.starts_with("sh") || name[2] < '1' ||
        name[2] > '0' + static_cast<int>(k_highest_degree))
        return std::shared_ptr<const Basis>();
    return std::shared_ptr<const Basis>(std::make_shared<SphericalHarmonics>(static_cast<std::size_t>(name[2] - '0')));
}

std::string SphericalHarmonics::name() const { return "sh" + std::to_string(harmonics_.degree()); }

std::string SphericalHarmonics::description() const {
    return "spherical harmonics of degree " + std::to_string(harmonics_.degree()) + ", " + std::to_string(size()) +
           " coefficients";
}

Matrix SphericalHarmonics::gram() const {
    Matrix identity(size() * size());
    for (std::size_t i = 0; i < size(); ++i) identity[i * size() + i] = 1;
    return identity;
}

std::vector<double> SphericalHarmonics::integrals() const {
    std::vector<double> result(size());
    result[0] = std::sqrt(4 * k_pi);
    return result;
}

std::shared_ptr<const Evaluator> SphericalHarmonics::evaluator(std::string_view name) const {
    for (Negative negative : {Negative::clamped, Negative::kept}) {
        auto found = std::make_shared<ConvolvedHarmonics>(harmonics_.degree(), negative);
        if (found->name() == name) return found;
    }
    return nullptr;
}

std::vector<float> SphericalHarmonics::lead_bounds() const {
    std::vector<float> bounds;
    for (std::size_t l = 0; l <= harmonics_.degree(); ++l)
        bounds.insert(bounds.end(), 2 * l + 1, std::sqrt(static_cast<float>(2 * l + 1)));
    return bounds;
}

Basis::Rotated SphericalHarmonics::rotated(const Rotation& r, std::span<const Rgb> c) const {
    return {std::make_shared<SphericalHarmonics>(harmonics_.degree()), harmonics::rotated(r, c)};
}

}  // namespace lobelia
