// Quadrature rules: Gauss-Legendre on an interval, and its product with equal azimuths on the sphere and hemisphere.
#pragma once

#include <vector>

#include "lobelia/sample.h"

namespace lobelia {

/// Nodes and weights on [low, high].
struct GaussLegendre {
    std::vector<double> nodes, weights;
    /// Exact for polynomials of degree 2 count - 1.
    explicit GaussLegendre(std::size_t count, double low = -1, double high = 1);
};

/// Points and weights [sr] that integrate functions of a direction over a domain.
struct SphereRule {
    Directions directions;
    std::vector<double> weights;
};

/// `heights` Gauss-Legendre nodes in z times 2 `heights` equal azimuths; on the sphere it is exact for spherical
/// polynomials of degree 2 heights - 1, on the hemisphere for those of the same degree.
[[nodiscard]] SphereRule product_rule(Domain domain, std::size_t heights);

class FunctionSet;
/// Integrals over the rule: G_ij = sum_q w_q f_i g_j, a size(f) x size(g) matrix row by row.
[[nodiscard]] std::vector<double> inner_products(const FunctionSet& f, const FunctionSet& g, const SphereRule& rule);
/// Integral over the rule of each function, and of each function's square.
[[nodiscard]] std::vector<double> integrals(const FunctionSet& f, const SphereRule& rule);
[[nodiscard]] std::vector<double> integrals_of_squares(const FunctionSet& f, const SphereRule& rule);

}  // namespace lobelia
