// Least squares: the non-negative kind from normal equations, and the oracle by QR.
#include "core/math/least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/dense.h"

namespace lobelia {

namespace {

/// Lawson and Hanson's active set: which coefficients are free to be positive, and how far they have come.
class FreeSet {
  public:
    FreeSet(const Eigen::MatrixXd& gram, const Eigen::VectorXd& target)
        : gram_(gram),
          target_(target),
          b_(Eigen::VectorXd::Zero(target.size())),
          barred_(static_cast<std::size_t>(target.size()), false),
          tolerance_(1e-12 * std::max(target.cwiseAbs().maxCoeff(), 1e-300)) {}

    /// Frees the coefficient with the largest gradient; returns -1 if none is positive.
    Eigen::Index free_next() {
        const Eigen::VectorXd gradient = target_ - gram_ * b_;
        Eigen::Index best = -1;
        for (Eigen::Index i = 0; i < b_.size(); ++i)
            if (!is_free(i) && gradient(i) > tolerance_ && !barred_[static_cast<std::size_t>(i)] &&
                (best < 0 || gradient(i) > gradient(best)))
                best = i;
        if (best >= 0) free_.push_back(best);
        return best;
    }

    /// Moves towards the solution of the free coefficients; fixes those that become negative at 0 again.
    void walk() {
        Eigen::VectorXd s = solve_free();
        while (!free_.empty() && s.minCoeff() <= 0) {
            double reach = 1;
            for (std::size_t k = 0; k < free_.size(); ++k) {
                const double at = b_(free_[k]), to = s(static_cast<Eigen::Index>(k));
                if (to <= 0) reach = std::min(reach, at / (at - to));
            }
            for (std::size_t k = 0; k < free_.size(); ++k)
                b_(free_[k]) += reach * (s(static_cast<Eigen::Index>(k)) - b_(free_[k]));
            std::erase_if(free_, [&](Eigen::Index i) { return b_(i) <= tolerance_ * 1e-3; });
            for (Eigen::Index i = 0; i < b_.size(); ++i)
                if (!is_free(i)) b_(i) = 0;
            if (!free_.empty()) s = solve_free();
        }
        for (std::size_t k = 0; k < free_.size(); ++k) b_(free_[k]) = s(static_cast<Eigen::Index>(k));
    }

    /// Bars a coefficient that rounding fixes at 0 again at once, until another one has moved; it would be freed for
    /// ever.
    void bar_if_fixed(Eigen::Index last_freed) {
        const bool stayed = is_free(last_freed);
        if (stayed) std::fill(barred_.begin(), barred_.end(), false);
        barred_[static_cast<std::size_t>(last_freed)] = !stayed;
    }

    [[nodiscard]] const Eigen::VectorXd& coefficients() const { return b_; }

  private:
    [[nodiscard]] bool is_free(Eigen::Index i) const { return std::find(free_.begin(), free_.end(), i) != free_.end(); }
    /// The unconstrained solution on the free ones alone.
    [[nodiscard]] Eigen::VectorXd solve_free() const {
        const Eigen::MatrixXd sub = gram_(free_, free_);
        return Eigen::VectorXd(sub.ldlt().solve(target_(free_)));
    }

    const Eigen::MatrixXd& gram_;
    const Eigen::VectorXd& target_;
    Eigen::VectorXd b_;
    std::vector<Eigen::Index> free_;
    std::vector<bool> barred_;
    double tolerance_;
};

}  // namespace

std::vector<double> non_negative_least_squares(const Matrix& gram, std::span<const double> m) {
    const auto n = static_cast<Eigen::Index>(m.size());
    const Eigen::MatrixXd g = as_matrix(gram, m.size());
    const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(m.data(), n);
    // The search compares numbers, which NaN would keep going for ever: what is not finite gives NaN.
    if (!g.allFinite() || !target.allFinite())
        return std::vector<double>(m.size(), std::numeric_limits<double>::quiet_NaN());
    FreeSet set(g, target);
    for (Eigen::Index step = 0; step < 10 * n; ++step) {
        const Eigen::Index freed = set.free_next();
        if (freed < 0) break;
        set.walk();
        set.bar_if_fixed(freed);
    }
    const Eigen::VectorXd& b = set.coefficients();
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
