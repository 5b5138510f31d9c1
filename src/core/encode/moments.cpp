// Moment encoders: one accumulator, several solvers.
#include "lobelia/encoders.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/encode/irradiance_norm.h"
#include "core/math/dense.h"
#include "core/math/kernels.h"
#include "core/math/least_squares.h"
#include "core/math/scratch.h"

namespace lobelia {
namespace {

using Eigen::MatrixXd;

class MomentEncoder final : public LinearEncoder {
  public:
    MomentEncoder(const std::shared_ptr<const LinearBasis>& basis_of, MomentSolver solver, const MomentOptions& options)
        : LinearEncoder(basis_of), solver_(solver), options_(options) {
        const LinearBasis& b = basis();
        if (solver == MomentSolver::projection) {
            double squared = 0;
            for (double integral : b.integrals()) squared += integral * integral;
            scale_ = solid_angle(b.domain()) / squared;
        } else if (solver == MomentSolver::analytic_gram) {
            gram_ = as_matrix(b.gram(), b.size());
            if (!is_diagonal(gram_)) factor_.compute(gram_);
        } else if (has_prior()) {
            gram_ = as_matrix(b.gram(), b.size());
            integrals_ = as_matrix(b.integrals(), 1);
        }
        if (is_joint()) irradiance_ = std::make_unique<IrradianceNorm>(b);
    }

    [[nodiscard]] std::size_t state_size() const override {
        const std::size_t n = basis().size();
        return header() + 3 * n + (has_gram() ? n * (n + 1) / 2 : 0) + (is_joint() ? 3 * harmonics_.size() : 0);
    }
    [[nodiscard]] Merging merging() const override { return Merging::exact; }
    [[nodiscard]] bool is_non_negative() const override {
        return solver_ == MomentSolver::non_negative || solver_ == MomentSolver::joint_non_negative;
    }

    void add(std::span<float> state, SampleView samples) const override {
        check_state(state);
        const std::size_t n = basis().size();
        float* gram = state.data() + header() + 3 * n;
        add_moments(state, samples, [&](SampleView block, const float* rows, float share) {
            state[k_weight] += share;
            if (has_prior()) add_squares(state, block);
            if (has_gram()) kernels::add_gram(rows, n, block, gram);
        });
    }

    void add_sources(std::span<float> state, SampleView sources) const override {
        check_state(state);
        add_moments(state, sources, [](SampleView, const float*, float) {});
    }

    void merge(std::span<float> state, std::span<const float> other) const override {
        check_state(state);
        check_state(other);
        for (std::size_t i = 0; i < state.size(); ++i) state[i] += other[i];
    }

    void solve(std::span<const float> state, std::span<Rgb> c) const override {
        check_state(state);
        const std::size_t n = basis().size();
        check_equal("coefficients", c.size(), n);
        if (!(state[k_weight] > 0)) {
            std::fill(c.begin(), c.end(), Rgb{});
            return;
        }
        const double normalise = solid_angle(basis().domain()) / state[k_weight];
        const MatrixXd m = normalise * triples(state.subspan(header(), 3 * n));
        const MatrixXd b = coefficients(state, m, normalise);
        for (std::size_t i = 0; i < n; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            c[i] = {static_cast<float>(b(row, 0)), static_cast<float>(b(row, 1)), static_cast<float>(b(row, 2))};
        }
    }

  private:
    /// State: the sum of w; with a prior also those of w v (three), w^2 and w |v|^2; then moments, Gram, harmonic
    /// moments.
    enum : std::size_t { k_weight, k_radiance, k_squared_weight = k_radiance + 3, k_squared_radiance, k_prior_header };
    [[nodiscard]] std::size_t header() const { return has_prior() ? k_prior_header : k_weight + 1; }

    [[nodiscard]] bool is_joint() const {
        return solver_ == MomentSolver::joint || solver_ == MomentSolver::joint_non_negative;
    }
    [[nodiscard]] bool has_prior() const { return solver_ == MomentSolver::regularised || is_joint(); }
    [[nodiscard]] bool has_gram() const {
        return has_prior() || solver_ == MomentSolver::sampled_gram || solver_ == MomentSolver::non_negative;
    }

    static MatrixXd triples(std::span<const float> values) {
        MatrixXd result(static_cast<Eigen::Index>(values.size() / 3), 3);
        for (std::size_t i = 0; i < values.size(); ++i)
            result(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = values[i];
        return result;
    }

    /// Adds the moments of w v; `with_rows(block, rows, sum of w)` sees the function values of each block.
    template <class WithRows>
    void add_moments(std::span<float> state, SampleView samples, const WithRows& with_rows) const {
        const std::size_t n = basis().size();
        const std::size_t most = is_joint() ? std::max(n, harmonics_.size()) : n;
        const Scratch rows(most * k_block_size);
        float* moments = state.data() + header();
        float* harmonic_moments = state.data() + state.size() - 3 * harmonics_.size();
        for_each_part(samples, k_block_size, [&](SampleView block, std::size_t) {
            basis().values(block.directions(), rows.data());
            const float share = kernels::add_moments(rows.data(), n, block, moments);
            if (has_prior()) add_radiance(state, block);
            with_rows(block, rows.data(), share);
            if (is_joint()) {
                harmonics_.values(block.directions(), rows.data());
                kernels::add_moments(rows.data(), harmonics_.size(), block, harmonic_moments);
            }
        });
    }

    static void add_radiance(std::span<float> state, SampleView block) {
        Rgb sum;
        for (std::size_t j = 0; j < block.size; ++j)
            sum = sum + colour_at(block.radiance(), j) * block.solid_angles()[j];
        state[k_radiance] += sum.r;
        state[k_radiance + 1] += sum.g;
        state[k_radiance + 2] += sum.b;
    }

    static void add_squares(std::span<float> state, SampleView block) {
        float squared_weight = 0, squared_radiance = 0;
        for (std::size_t j = 0; j < block.size; ++j) {
            const Rgb v = colour_at(block.radiance(), j);
            const float w = block.solid_angles()[j];
            squared_weight += w * w;
            squared_radiance += w * (v.r * v.r + v.g * v.g + v.b * v.b);
        }
        state[k_squared_weight] += squared_weight;
        state[k_squared_radiance] += squared_radiance;
    }

    /// Functions that nowhere overlap, and those that are orthogonal, leave nothing to eliminate.
    static bool is_diagonal(const MatrixXd& gram) { return gram.isDiagonal(0); }
    /// G^-1 m, `factor` G where that is not diagonal.
    static MatrixXd solve_with(const MatrixXd& gram, const Eigen::LDLT<MatrixXd>& factor, const MatrixXd& m) {
        if (!is_diagonal(gram)) return factor.solve(m);
        // A function that no sample has met has a sum of 0, and gets 0 as from the factors.
        MatrixXd result = MatrixXd::Zero(m.rows(), m.cols());
        for (Eigen::Index i = 0; i < m.rows(); ++i)
            if (gram(i, i) > 0) result.row(i) = m.row(i) / gram(i, i);
        return result;
    }
    static MatrixXd solve_symmetric(const MatrixXd& gram, const MatrixXd& m) {
        return solve_with(gram, is_diagonal(gram) ? Eigen::LDLT<MatrixXd>() : gram.ldlt(), m);
    }

    [[nodiscard]] MatrixXd sampled_gram(std::span<const float> state, double normalise) const {
        const auto n = static_cast<Eigen::Index>(basis().size());
        const float* next = state.data() + header() + 3 * basis().size();
        MatrixXd gram(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = i; j < n; ++j) gram(i, j) = gram(j, i) = normalise * *next++;
        gram.diagonal() *= 1 + k_gram_ridge;
        return gram;
    }

    [[nodiscard]] MatrixXd coefficients(std::span<const float> state, const MatrixXd& m, double normalise) const {
        switch (solver_) {
            case MomentSolver::projection:
                return scale_ * m;
            case MomentSolver::analytic_gram:
                return solve_with(gram_, factor_, m);
            case MomentSolver::sampled_gram:
                return solve_symmetric(sampled_gram(state, normalise), m);
            case MomentSolver::regularised: {
                const Blend blend = blended(state, m, normalise);
                return solve_symmetric(blend.gram, blend.m);
            }
            case MomentSolver::non_negative:
                return solve_non_negative(sampled_gram(state, normalise), m);
            case MomentSolver::joint:
            case MomentSolver::joint_non_negative:
                return solve_joint(state, m, normalise);
        }
        return {};
    }

    /// Normal equations that are good at every count: what was sampled, and a share k of what is known beforehand,
    /// the exact Gram matrix and the moments of a constant environment with the sampled mean radiance. Where constants
    /// are in the span of the basis, a constant environment is then exact from the first sample on.
    struct Blend {
        MatrixXd gram, m;
        double share;   ///< k
        MatrixXd mean;  ///< radiance, 1 x 3
    };
    [[nodiscard]] Blend blended(std::span<const float> state, const MatrixXd& m, double normalise) const {
        // Unequal weights count as fewer samples: N = (sum w)^2 / sum w^2. The quadratic term lets k fall faster than
        // the error of any sampling, 1 / N at best, so that it costs nothing where all is known; 8 leaves k = n / (N +
        // n) nearly as it is where few samples are.
        const auto n = static_cast<double>(basis().size());
        const double count = std::pow(static_cast<double>(state[k_weight]), 2) / state[k_squared_weight];
        const double k = n / (n + count + count * count / (8 * n));
        const MatrixXd mean = triples(state.subspan(k_radiance, 3)) / state[k_weight];
        return {(1 - k) * sampled_gram(state, normalise) + k * gram_, (1 - k) * m + k * (integrals_ * mean), k, mean};
    }

    [[nodiscard]] MatrixXd solve_joint(std::span<const float> state, const MatrixXd& m, double normalise) const {
        const Blend blend = blended(state, m, normalise);
        const MatrixXd harmonic = (1 - blend.share) * normalise * triples(state.last(3 * harmonics_.size())) +
                                  blend.share * irradiance_->constant * blend.mean;
        const double radiance = normalise * state[k_squared_radiance];
        const double irradiance = (irradiance_->squared_cosine.asDiagonal() * harmonic.cwiseAbs2()).sum();
        const double w = irradiance > 0 ? options_.irradiance_weight * radiance / irradiance : 0;
        const MatrixXd gram = blend.gram + w * irradiance_->gram;
        const MatrixXd target = blend.m + w * (irradiance_->functions * harmonic);
        return is_non_negative() ? solve_non_negative(gram, target) : solve_symmetric(gram, target);
    }

    static MatrixXd solve_non_negative(const MatrixXd& gram, const MatrixXd& m) {
        const Matrix rows(gram.data(), gram.data() + gram.size());  // symmetric: columns are rows
        MatrixXd result(m.rows(), 3);
        for (Eigen::Index channel = 0; channel < 3; ++channel) {
            const Eigen::VectorXd column = m.col(channel);
            const auto b = non_negative_least_squares(rows, {column.data(), static_cast<std::size_t>(column.size())});
            result.col(channel) = Eigen::Map<const Eigen::VectorXd>(b.data(), m.rows());
        }
        return result;
    }

    MomentSolver solver_;
    MomentOptions options_;
    double scale_ = 1;
    MatrixXd gram_;
    Eigen::VectorXd integrals_;
    Eigen::LDLT<MatrixXd> factor_;
    harmonics::Harmonics harmonics_{k_irradiance_degree};
    std::unique_ptr<IrradianceNorm> irradiance_;
};

}  // namespace

std::shared_ptr<const Encoder> make_moment_encoder(std::shared_ptr<const LinearBasis> basis, MomentSolver solver,
                                                   const MomentOptions& options) {
    return std::make_shared<MomentEncoder>(std::move(basis), solver, options);
}

}  // namespace lobelia
