// Spherical harmonics as a basis.
#include "core/basis/sh/spherical_harmonics.h"

namespace lobelia {
namespace {

constexpr std::size_t k_highest_degree = 8;

}  // namespace

std::shared_ptr<const LinearBasis> spherical_harmonics(std::size_t degree) {
    check_range("degree", degree, 1, k_highest_degree);
    return std::make_shared<SphericalHarmonics>(degree);
}

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

std::vector<float> SphericalHarmonics::lead_bounds() const {
    std::vector<float> bounds;
    for (std::size_t l = 0; l <= harmonics_.degree(); ++l)
        bounds.insert(bounds.end(), 2 * l + 1, std::sqrt(static_cast<float>(2 * l + 1)));
    return bounds;
}

Basis::Rotated SphericalHarmonics::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    return {std::make_shared<SphericalHarmonics>(harmonics_.degree()), harmonics::rotated(r, c)};
}

}  // namespace lobelia
