// Least squares: the non-negative kind from normal equations, and the oracle by QR.
#include "lobelia/encode/least_squares.h"

#include <algorithm>
#include <cmath>

#include "lobelia/encode/dense.h"

namespace lobelia {

std::vector<double> non_negative_least_squares(const Matrix& gram, std::span<const double> m) {
    const auto n = static_cast<Eigen::Index>(m.size());
    const Eigen::MatrixXd g = as_matrix(gram, m.size());
    const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(m.data(), n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> passive;
    std::vector<bool> barred(m.size(), false);
    const double tolerance = 1e-12 * std::max(target.cwiseAbs().maxCoeff(), 1e-300);

    // The unconstrained solution on the passive set alone.
    const auto solve_passive = [&] {
        const Eigen::MatrixXd sub = g(passive, passive);
        return Eigen::VectorXd(sub.ldlt().solve(target(passive)));
    };
    for (Eigen::Index step = 0; step < 10 * n; ++step) {
        // Free the coefficient that wants most to grow; done when none does.
        const Eigen::VectorXd gradient = target - g * b;
        Eigen::Index best = -1;
        for (Eigen::Index i = 0; i < n; ++i)
            if (std::find(passive.begin(), passive.end(), i) == passive.end() && gradient(i) > tolerance &&
                !barred[static_cast<std::size_t>(i)] && (best < 0 || gradient(i) > gradient(best)))
                best = i;
        if (best < 0) break;
        passive.push_back(best);

        // Walk towards the passive solution; whatever would turn negative on the way is fixed at 0 again.
        Eigen::VectorXd s = solve_passive();
        while (!passive.empty() && s.minCoeff() <= 0) {
            double reach = 1;
            for (std::size_t k = 0; k < passive.size(); ++k) {
                const double at = b(passive[k]), to = s(static_cast<Eigen::Index>(k));
                if (to <= 0) reach = std::min(reach, at / (at - to));
            }
            for (std::size_t k = 0; k < passive.size(); ++k)
                b(passive[k]) += reach * (s(static_cast<Eigen::Index>(k)) - b(passive[k]));
            std::erase_if(passive, [&](Eigen::Index i) { return b(i) <= tolerance * 1e-3; });
            for (Eigen::Index i = 0; i < n; ++i)
                if (std::find(passive.begin(), passive.end(), i) == passive.end()) b(i) = 0;
            if (!passive.empty()) s = solve_passive();
        }
        for (std::size_t k = 0; k < passive.size(); ++k) b(passive[k]) = s(static_cast<Eigen::Index>(k));

        // What rounding fixes at 0 again at once would be freed for ever; bar it until something else has moved.
        const bool stayed = std::find(passive.begin(), passive.end(), best) != passive.end();
        if (stayed) std::fill(barred.begin(), barred.end(), false);
        barred[static_cast<std::size_t>(best)] = !stayed;
    }
    return {b.data(), b.data() + n};
}

std::vector<Rgb> least_squares_by_qr(const LinearBasis& basis, SampleView samples) {
    const auto n = static_cast<Eigen::Index>(basis.size());
    Eigen::MatrixXd design(static_cast<Eigen::Index>(samples.size), n), target(design.rows(), 3);
    std::vector<float> rows(basis.size() * k_block_size);
    for_each_part(samples, k_block_size, [&](SampleView block, std::size_t begin) {
        basis.values(block.directions(), rows.data());
        for (std::size_t j = 0; j < block.size; ++j) {
            const auto row = static_cast<Eigen::Index>(begin + j);
            const double root = std::sqrt(static_cast<double>(block.solid_angles()[j]));
            for (Eigen::Index i = 0; i < n; ++i)
                design(row, i) = root * rows[static_cast<std::size_t>(i) * k_block_size + j];
            const Rgb v = colour_at(block.radiance(), j);
            target.row(row) << root * v.r, root * v.g, root * v.b;
        }
    });
    const Eigen::MatrixXd b = design.colPivHouseholderQr().solve(target);
    std::vector<Rgb> c(basis.size());
    for (Eigen::Index i = 0; i < n; ++i)
        c[static_cast<std::size_t>(i)] = {static_cast<float>(b(i, 0)), static_cast<float>(b(i, 1)),
                                          static_cast<float>(b(i, 2))};
    return c;
}

}  // namespace lobelia
