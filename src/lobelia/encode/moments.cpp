// Moment encoders: one accumulator, several solvers.
#include "lobelia/encode/moments.h"

#include <Eigen/Dense>
#include <cmath>

#include "lobelia/harmonics.h"
#include "lobelia/kernels.h"
#include "lobelia/quadrature.h"

namespace lobelia {
namespace {

using Eigen::MatrixXd;

Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> as_matrix(
    const std::vector<double>& values, std::size_t columns) {
    return {values.data(), static_cast<Eigen::Index>(values.size() / columns), static_cast<Eigen::Index>(columns)};
}

/// Degree to which irradiance is followed in the joint norm: A_l^2 beyond it is below 7e-5 of A_0^2.
constexpr std::size_t k_irradiance_degree = 6;

/// What the joint norm needs to know of a basis: irradiance is diagonal in spherical harmonics.
struct IrradianceNorm {
    MatrixXd gram;       ///< <E_i, E_j> over all normals
    MatrixXd functions;  ///< row i: A_l^2 times the harmonic coefficients of B_i
    Eigen::VectorXd constant;  ///< harmonic coefficients of the constant 1 on the domain
    Eigen::VectorXd squared_cosine;

    explicit IrradianceNorm(const Basis& basis) {
        const harmonics::Harmonics harmonics(k_irradiance_degree);
        const MatrixXd g = project(basis, harmonics);
        squared_cosine.resize(static_cast<Eigen::Index>(harmonics.size()));
        for (std::size_t l = 0; l <= k_irradiance_degree; ++l)
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
                squared_cosine(static_cast<Eigen::Index>(i)) = std::pow(harmonics::clamped_cosine(l), 2);
        functions = g * squared_cosine.asDiagonal();
        gram = functions * g.transpose();

        const SphereRule rule = product_rule(basis.domain(), 16);
        std::vector<float> rows(harmonics.size() * k_block_size);
        constant = Eigen::VectorXd::Zero(squared_cosine.size());
        for_each_part(rule.directions.view(), k_block_size, [&](DirectionView block, std::size_t begin) {
            harmonics.values(block, rows.data());
            for (std::size_t i = 0; i < harmonics.size(); ++i)
                for (std::size_t j = 0; j < block.size; ++j)
                    constant(static_cast<Eigen::Index>(i)) +=
                        rule.weights[begin + j] * static_cast<double>(rows[i * k_block_size + j]);
        });
    }

    /// Harmonic coefficients of each basis function, with as many quadrature nodes as its own square needs. On the
    /// hemisphere too they are those of whole functions, since evaluators read them whole.
    static MatrixXd project(const Basis& basis, const harmonics::Harmonics& harmonics) {
        const Matrix gram = basis.gram();
        for (std::size_t heights = 32;; heights *= 2) {
            if (heights < 512 && !resolves(basis, gram, product_rule(basis.domain(), heights))) continue;
            const SphereRule sphere = product_rule(Domain::sphere, heights);
            return as_matrix(inner_products(basis, harmonics, sphere), harmonics.size());
        }
    }

    static bool resolves(const Basis& basis, const Matrix& gram, const SphereRule& rule) {
        const std::size_t n = basis.size();
        std::vector<double> squares(n);
        std::vector<float> rows(n * k_block_size);
        for_each_part(rule.directions.view(), k_block_size, [&](DirectionView block, std::size_t begin) {
            basis.values(block, rows.data());
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < block.size; ++j)
                    squares[i] += rule.weights[begin + j] * std::pow(static_cast<double>(rows[i * k_block_size + j]), 2);
        });
        for (std::size_t i = 0; i < n; ++i)
            if (std::abs(squares[i] - gram[i * n + i]) > 1e-5 * gram[i * n + i]) return false;
        return true;
    }
};

class MomentEncoder final : public Encoder {
  public:
    MomentEncoder(std::shared_ptr<const Basis> basis_of, MomentSolver solver, const MomentOptions& options)
        : Encoder(std::move(basis_of)), solver_(solver), options_(options) {
        const Basis& b = basis();
        if (solver == MomentSolver::projection) {
            double squared = 0;
            for (double integral : b.integrals()) squared += integral * integral;
            scale_ = solid_angle(b.domain()) / squared;
        } else if (solver == MomentSolver::analytic_gram) {
            gram_ = as_matrix(b.gram(), b.size());
            factor_.compute(gram_);
        } else if (has_prior()) {
            gram_ = as_matrix(b.gram(), b.size());
            integrals_ = as_matrix(b.integrals(), 1);
        }
        if (is_joint()) irradiance_ = std::make_unique<IrradianceNorm>(b);
    }

    [[nodiscard]] std::size_t state_size() const override {
        const std::size_t n = basis().size();
        return k_header + 3 * n + (has_gram() ? n * (n + 1) / 2 : 0) + (is_joint() ? 3 * harmonics_.size() : 0);
    }
    [[nodiscard]] Merging merging() const override { return Merging::exact; }
    [[nodiscard]] bool is_non_negative() const override {
        return solver_ == MomentSolver::non_negative || solver_ == MomentSolver::joint_non_negative;
    }

    void add(std::span<float> state, SampleView samples) const override {
        const std::size_t n = basis().size();
        const std::size_t most = is_joint() ? std::max(n, harmonics_.size()) : n;
        std::vector<float> rows(most * k_block_size);
        float* moments = state.data() + k_header;
        float* gram = moments + 3 * n;
        float* harmonic_moments = gram + n * (n + 1) / 2;
        for_each_part(samples, k_block_size, [&](SampleView block, std::size_t) {
            basis().values(block.directions(), rows.data());
            state[k_weight] += kernels::add_moments(rows.data(), n, block, moments);
            add_header(state, block);
            if (has_gram()) kernels::add_gram(rows.data(), n, block, gram);
            if (is_joint()) {
                harmonics_.values(block.directions(), rows.data());
                kernels::add_moments(rows.data(), harmonics_.size(), block, harmonic_moments);
            }
        });
    }

    void merge(std::span<float> state, std::span<const float> other) const override {
        for (std::size_t i = 0; i < state.size(); ++i) state[i] += other[i];
    }

    void solve(std::span<const float> state, std::span<Rgb> c) const override {
        const std::size_t n = basis().size();
        if (!(state[k_weight] > 0)) {
            std::fill(c.begin(), c.end(), Rgb{});
            return;
        }
        const double normalise = solid_angle(basis().domain()) / state[k_weight];
        const MatrixXd m = normalise * triples(state.subspan(k_header, 3 * n));
        const MatrixXd b = coefficients(state, m, normalise);
        for (std::size_t i = 0; i < n; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            c[i] = {static_cast<float>(b(row, 0)), static_cast<float>(b(row, 1)), static_cast<float>(b(row, 2))};
        }
    }

  private:
    /// State: sums of w, w^2, w v (three) and w |v|^2, then moments, Gram, harmonic moments.
    enum : std::size_t { k_weight, k_squared_weight, k_radiance, k_squared_radiance = k_radiance + 3, k_header };

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

    void add_header(std::span<float> state, SampleView block) const {
        if (!has_prior()) return;
        float squared_weight = 0, squared_radiance = 0;
        Rgb radiance;
        for (std::size_t j = 0; j < block.size; ++j) {
            const Rgb v = colour_at(block.radiance(), j);
            const float w = block.solid_angles()[j];
            squared_weight += w * w;
            radiance = radiance + v * w;
            squared_radiance += w * (v.r * v.r + v.g * v.g + v.b * v.b);
        }
        state[k_squared_weight] += squared_weight;
        state[k_radiance] += radiance.r;
        state[k_radiance + 1] += radiance.g;
        state[k_radiance + 2] += radiance.b;
        state[k_squared_radiance] += squared_radiance;
    }

    [[nodiscard]] MatrixXd sampled_gram(std::span<const float> state, double normalise) const {
        const auto n = static_cast<Eigen::Index>(basis().size());
        const float* next = state.data() + k_header + 3 * n;
        MatrixXd gram(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = i; j < n; ++j) gram(i, j) = gram(j, i) = normalise * *next++;
        // The least ridge that a Gram matrix summed in float32 can be told apart from.
        gram.diagonal().array() += 1e-7 * gram.trace() / static_cast<double>(n);
        return gram;
    }

    [[nodiscard]] MatrixXd coefficients(std::span<const float> state, const MatrixXd& m, double normalise) const {
        switch (solver_) {
            case MomentSolver::projection: return scale_ * m;
            case MomentSolver::analytic_gram: return factor_.solve(m);
            case MomentSolver::sampled_gram: return sampled_gram(state, normalise).ldlt().solve(m);
            case MomentSolver::regularised: {
                const Blend blend = blended(state, m, normalise);
                return blend.gram.ldlt().solve(blend.m);
            }
            case MomentSolver::non_negative: return solve_non_negative(sampled_gram(state, normalise), m);
            case MomentSolver::joint:
            case MomentSolver::joint_non_negative: return solve_joint(state, m, normalise);
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
        // Unequal weights count as fewer samples: N = (sum w)^2 / sum w^2. The quadratic term lets k fall faster than the
        // error of any sampling, 1 / N at best, so that it costs nothing where all is known; 8 leaves k = n / (N + n)
        // nearly as it is where few samples are.
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
        return is_non_negative() ? solve_non_negative(gram, target) : gram.ldlt().solve(target);
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

std::shared_ptr<const Encoder> make_moment_encoder(std::shared_ptr<const Basis> basis, MomentSolver solver,
                                                   const MomentOptions& options) {
    return std::make_shared<MomentEncoder>(std::move(basis), solver, options);
}

std::vector<double> non_negative_least_squares(const Matrix& gram, std::span<const double> m) {
    const auto n = static_cast<Eigen::Index>(m.size());
    const MatrixXd g = as_matrix(gram, m.size());
    const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(m.data(), n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> passive;
    const double tolerance = 1e-12 * std::max(target.cwiseAbs().maxCoeff(), 1e-300);

    // The unconstrained solution on the passive set alone.
    const auto solve_passive = [&] {
        const MatrixXd sub = g(passive, passive);
        return Eigen::VectorXd(sub.ldlt().solve(target(passive)));
    };
    for (Eigen::Index step = 0; step < 10 * n; ++step) {
        // Free the coefficient that wants most to grow; done when none does.
        const Eigen::VectorXd gradient = target - g * b;
        Eigen::Index best = -1;
        for (Eigen::Index i = 0; i < n; ++i)
            if (std::find(passive.begin(), passive.end(), i) == passive.end() && gradient(i) > tolerance &&
                (best < 0 || gradient(i) > gradient(best)))
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
    }
    return {b.data(), b.data() + n};
}

std::vector<Rgb> least_squares_by_qr(const Basis& basis, SampleView samples) {
    const auto n = static_cast<Eigen::Index>(basis.size());
    MatrixXd design(static_cast<Eigen::Index>(samples.size), n), target(design.rows(), 3);
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
    const MatrixXd b = design.colPivHouseholderQr().solve(target);
    std::vector<Rgb> c(basis.size());
    for (Eigen::Index i = 0; i < n; ++i)
        c[static_cast<std::size_t>(i)] = {static_cast<float>(b(i, 0)), static_cast<float>(b(i, 1)),
                                          static_cast<float>(b(i, 2))};
    return c;
}

}  // namespace lobelia
