// Harmonic coefficients of any basis by quadrature, and what the joint norm makes of them.
#include "core/encode/irradiance_norm.h"

#include <cmath>

#include "core/math/dense.h"
#include "core/math/quadrature.h"

namespace lobelia {
namespace {

/// Returns whether the rule integrates each function's square.
bool resolves(const LinearBasis& basis, const Matrix& gram, const SphereRule& rule) {
    const std::vector<double> squares = integrals_of_squares(basis, rule);
    for (std::size_t i = 0; i < basis.size(); ++i) {
        const double known = gram[i * basis.size() + i];
        if (std::abs(squares[i] - known) > 1e-5 * known) return false;
    }
    return true;
}

/// Harmonic coefficients of each basis function, with as many quadrature nodes as its own square needs. On the
/// hemisphere too they are those of whole functions, since evaluators read them whole.
Eigen::MatrixXd project(const LinearBasis& basis, const harmonics::Harmonics& harmonics) {
    const Matrix gram = basis.gram();
    std::size_t heights = 32;
    while (heights < 512 && !resolves(basis, gram, product_rule(basis.domain(), heights))) heights *= 2;
    return as_matrix(inner_products(basis, harmonics, product_rule(Domain::sphere, heights)), harmonics.size());
}

}  // namespace

IrradianceNorm::IrradianceNorm(const LinearBasis& basis) {
    const harmonics::Harmonics harmonics(k_irradiance_degree);
    squared_cosine.resize(static_cast<Eigen::Index>(harmonics.size()));
    for (std::size_t l = 0; l <= k_irradiance_degree; ++l)
        for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
            squared_cosine(static_cast<Eigen::Index>(i)) = std::pow(harmonics::clamped_cosine(l), 2);
    const Eigen::MatrixXd g = project(basis, harmonics);
    functions = g * squared_cosine.asDiagonal();
    gram = functions * g.transpose();
    constant = as_matrix(integrals(harmonics, product_rule(basis.domain(), 16)), 1);
}

}  // namespace lobelia
