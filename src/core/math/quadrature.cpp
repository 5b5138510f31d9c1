// Quadrature rules by Newton's method on Legendre polynomials, and inner products of function sets over them.
#include "core/math/quadrature.h"

#include <Eigen/Dense>

#include "lobelia/basis.h"

namespace lobelia {

GaussLegendre::GaussLegendre(std::size_t count, double low, double high) : nodes(count), weights(count) {
    const auto n = static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        // Start from the asymptotic zero, then polish P_n(x) = 0.
        double x = std::cos(k_pi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 1;
        for (int iteration = 0; iteration < 100; ++iteration) {
            double p = 1, previous = 0;
            for (std::size_t k = 1; k <= count; ++k) {
                const auto m = static_cast<double>(k);
                const double next = ((2 * m - 1) * x * p - (m - 1) * previous) / m;
                previous = p;
                p = next;
            }
            slope = n * (x * p - previous) / (x * x - 1);
            const double step = p / slope;
            x -= step;
            if (std::abs(step) < 1e-15) break;
        }
        nodes[count - 1 - i] = low + (high - low) * (x + 1) / 2;
        weights[count - 1 - i] = (high - low) / ((1 - x * x) * slope * slope);
    }
}

SphereRule product_rule(Domain domain, std::size_t heights) {
    const GaussLegendre z_rule(heights, domain == Domain::sphere ? -1 : 0, 1);
    const std::size_t azimuths = 2 * heights;
    SphereRule rule{Directions(heights * azimuths), {}};
    rule.weights.reserve(heights * azimuths);
    std::vector<double> cosines, sines;
    for (std::size_t j = 0; j < azimuths; ++j) {
        const double phi = 2 * k_pi * (static_cast<double>(j) + 0.5) / static_cast<double>(azimuths);
        cosines.push_back(std::cos(phi));
        sines.push_back(std::sin(phi));
    }
    for (std::size_t i = 0; i < heights; ++i)
        for (std::size_t j = 0; j < azimuths; ++j) {
            const double z = z_rule.nodes[i], r = std::sqrt(1 - z * z);
            set_entry(
                rule.directions.view(), i * azimuths + j,
                Vec3{static_cast<float>(r * cosines[j]), static_cast<float>(r * sines[j]), static_cast<float>(z)});
            rule.weights.push_back(z_rule.weights[i] * 2 * k_pi / static_cast<double>(azimuths));
        }
    return rule;
}

namespace {

/// Sum over the rule's points of weight times `of(value)`, for each function.
template <class Of>
std::vector<double> summed(const FunctionSet& f, const SphereRule& rule, const Of& of) {
    std::vector<double> sums(f.size());
    std::vector<float> rows(f.size() * k_block_size);
    for_each_part(rule.directions.view(), k_block_size, [&](DirectionView block, std::size_t begin) {
        f.values(block, rows.data());
        for (std::size_t i = 0; i < f.size(); ++i)
            for (std::size_t j = 0; j < block.size; ++j)
                sums[i] += rule.weights[begin + j] * of(static_cast<double>(rows[i * k_block_size + j]));
    });
    return sums;
}

}  // namespace

std::vector<double> integrals(const FunctionSet& f, const SphereRule& rule) {
    return summed(f, rule, [](double value) { return value; });
}

std::vector<double> integrals_of_squares(const FunctionSet& f, const SphereRule& rule) {
    return summed(f, rule, [](double value) { return value * value; });
}

std::vector<double> inner_products(const FunctionSet& f, const FunctionSet& g, const SphereRule& rule) {
    // A product of matrices for each block: weighted values of f times values of g.
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto f_count = static_cast<Eigen::Index>(f.size()), g_count = static_cast<Eigen::Index>(g.size());
    std::vector<double> result(f.size() * g.size());
    Eigen::Map<Rows> products(result.data(), f_count, g_count);
    std::vector<float> f_rows(f.size() * k_block_size), g_rows(g.size() * k_block_size);
    const auto block_of = [](const std::vector<float>& rows, Eigen::Index count, std::size_t size) {
        using Floats = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const Eigen::Map<const Floats> all(rows.data(), count, static_cast<Eigen::Index>(k_block_size));
        return all.leftCols(static_cast<Eigen::Index>(size)).cast<double>().eval();
    };
    for_each_part(rule.directions.view(), k_block_size, [&](DirectionView block, std::size_t begin) {
        f.values(block, f_rows.data());
        g.values(block, g_rows.data());
        const Eigen::Map<const Eigen::VectorXd> weights(rule.weights.data() + begin,
                                                        static_cast<Eigen::Index>(block.size));
        Rows weighted = block_of(f_rows, f_count, block.size);
        weighted *= weights.asDiagonal();
        products.noalias() += weighted * block_of(g_rows, g_count, block.size).transpose();
    });
    return result;
}

}  // namespace lobelia
