// Tests the sequential encoders against their published formulae, written again in plain double precision.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>
#include <random>

#include "core/math/least_squares.h"
#include "core/math/small_nnls.h"
#include "lobelia/codec.h"
#include "lobelia/encoders.h"
#include "lobelia/environment.h"
#include "lobelia/sampling.h"
#include "lobelia/sky.h"

namespace lobelia {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One step: changes b (functions x 3) for function values w, radiance v and the sample's number and weight share.
struct Step {
    double weight = 0;  ///< omega
    double total = 0;   ///< sum of omega so far, this one too
    std::size_t count = 0;
};
using Update = std::function<void(MatrixXd& b, const VectorXd& w, const Eigen::RowVector3d& v, const Step& step)>;

MatrixXd run_plainly(const LinearBasis& basis, const Samples& samples, const Update& update) {
    const auto n = static_cast<Eigen::Index>(basis.size());
    MatrixXd b = MatrixXd::Zero(n, 3);
    std::vector<float> rows(basis.size() * k_block_size);
    Step step;
    for (std::size_t j = 0; j < samples.size(); ++j) {
        const RadianceSample s = samples[j];
        Directions direction(1);
        set_entry(direction.view(), 0, s.direction);
        basis.values(direction, rows.data());
        VectorXd w(n);
        for (Eigen::Index i = 0; i < n; ++i) w(i) = rows[static_cast<std::size_t>(i) * k_block_size];
        step.weight = s.solid_angle;
        step.total += s.solid_angle;
        ++step.count;
        update(b, w, {s.radiance.r, s.radiance.g, s.radiance.b}, step);
    }
    return b;
}

void expect_near(const std::shared_ptr<const Encoder>& encoder, const Samples& samples, const Update& update) {
    Accumulator accumulator(encoder);
    accumulator.add(samples);
    const auto c = accumulator.solve();
    const MatrixXd b = run_plainly(*encoder->basis().linear(), samples, update);
    const double scale = b.cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 0);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
        const Rgb found = c[static_cast<std::size_t>(i)];
        EXPECT_NEAR(found.r, b(i, 0), 1e-4 * scale) << "coefficient " << i;
        EXPECT_NEAR(found.g, b(i, 1), 1e-4 * scale) << "coefficient " << i;
        EXPECT_NEAR(found.b, b(i, 2), 1e-4 * scale) << "coefficient " << i;
    }
}

/// 300 samples of unequal weights.
Samples unequal_samples(Domain domain) {
    const Image environment = sky({64, 32});
    Samples samples = directed_samples(environment, uniform_directions(domain, Sequence::random, 300, 5), domain);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        RadianceSample s = samples[i];
        s.solid_angle *= 0.5f + static_cast<float>(i % 7) / 7;
        samples.set(i, s);
    }
    return samples;
}

VectorXd mean_squares(const LinearBasis& basis) {
    const auto n = static_cast<Eigen::Index>(basis.size());
    const Matrix gram = basis.gram();
    return Eigen::Map<const MatrixXd>(gram.data(), n, n).diagonal() / solid_angle(basis.domain());
}

Update running_average(double lowest) {
    return [sums = VectorXd(), lowest](MatrixXd& b, const VectorXd& w, const Eigen::RowVector3d& v,
                                       const Step& step) mutable {
        if (sums.size() == 0) sums = VectorXd::Zero(w.size());
        const Eigen::RowVector3d delta = v - w.transpose() * b;
        sums += step.weight * w;
        for (Eigen::Index i = 0; i < w.size(); ++i)
            b.row(i) = (b.row(i) + step.weight * w(i) / sums(i) * delta).cwiseMax(lowest);
    };
}

/// The corrected form with every published choice.
Update progressive(const VectorXd& exact, const ProgressiveOptions& options, double lowest) {
    using Denominator = ProgressiveOptions::Denominator;
    struct State {
        VectorXd m;
        double total = 0;
    };
    return [=, state = State{VectorXd::Zero(exact.size()), 0}](MatrixXd& b, const VectorXd& w,
                                                               const Eigen::RowVector3d& v, const Step& step) mutable {
        if (step.count == 1)
            for (std::size_t i = 0; i < options.seed.size(); ++i)
                b.row(static_cast<Eigen::Index>(i)) << options.seed[i].r, options.seed[i].g, options.seed[i].b;
        const double ramp = options.ramp ? 1 - std::exp(-static_cast<double>(step.count) / *options.ramp) : 1;
        state.total += step.weight * ramp;
        const double a = step.weight * ramp / state.total;
        Eigen::RowVector3d delta = v - w.transpose() * b;
        for (Eigen::Index i = 0; i < w.size(); ++i) {
            const bool given = options.denominator == Denominator::sampled && !options.acceleration && step.count == 1;
            state.m(i) = given ? options.first_mean_square.value_or(static_cast<float>(exact(i)))
                               : state.m(i) + (w(i) * w(i) - state.m(i)) * a;
            if (options.acceleration) {
                const double s = a + (1 - a) * state.m(i);
                const Eigen::RowVector3d moved =
                    (b.row(i) + *options.acceleration * a * w(i) / s * delta).cwiseMax(lowest);
                delta -= (moved - b.row(i)) * w(i);
                b.row(i) = moved;
                continue;
            }
            const double s = options.denominator == Denominator::clamped   ? std::max(state.m(i), exact(i))
                             : options.denominator == Denominator::sampled ? state.m(i)
                                                                           : exact(i);
            b.row(i) = (b.row(i) + ((delta + b.row(i) * w(i)) * w(i) / s - b.row(i)) * a).cwiseMax(lowest);
        }
    };
}

constexpr double k_no_limit = -1e30;

TEST(RunningAverage, FollowsItsFormula) {
    const auto basis = as_linear(make_basis("sg12").value());
    const Samples samples = unequal_samples(basis->domain());
    expect_near(make_running_average(basis, Sign::any), samples, running_average(k_no_limit));
    expect_near(make_running_average(basis, Sign::non_negative), samples, running_average(0));
}

TEST(Progressive, EveryChoiceFollowsItsFormula) {
    using Denominator = ProgressiveOptions::Denominator;
    const std::vector<ProgressiveOptions> choices = {
        {},
        {.denominator = Denominator::sampled},
        {.denominator = Denominator::sampled, .first_mean_square = 0.1f},
        {.denominator = Denominator::exact},
        {.ramp = 50},
        {.seed = std::vector<Rgb>(12, Rgb{1, 2, 3})},
        {.acceleration = 3},
    };
    for (const char* name : {"sg12", "sg12h"}) {
        const auto basis = as_linear(make_basis(name).value());
        const Samples samples = unequal_samples(basis->domain());
        for (std::size_t k = 0; k < choices.size(); ++k)
            for (Sign sign : {Sign::any, Sign::non_negative}) {
                SCOPED_TRACE(std::string(name) + ", choice " + std::to_string(k));
                expect_near(make_progressive(basis, sign, choices[k]), samples,
                            progressive(mean_squares(*basis), choices[k], sign == Sign::any ? k_no_limit : 0));
            }
    }
}

TEST(MatrixGain, FollowsItsFormula) {
    for (const char* name : {"sg12", "sg12h", "sh2"}) {
        const auto basis = as_linear(make_basis(name).value());
        const auto n = static_cast<Eigen::Index>(basis->size());
        const Matrix gram = basis->gram();
        const MatrixXd inverse =
            (Eigen::Map<const MatrixXd>(gram.data(), n, n) / solid_angle(basis->domain())).inverse();
        SCOPED_TRACE(name);
        expect_near(make_matrix_gain(basis), unequal_samples(basis->domain()),
                    [&](MatrixXd& b, const VectorXd& w, const Eigen::RowVector3d& v, const Step& step) {
                        // 1 / (N + n), where sum omega / omega stands for N.
                        const double damping = 1 + static_cast<double>(n) / static_cast<double>(step.count);
                        b += inverse * w * (v - w.transpose() * b) * (step.weight / (step.total * damping));
                    });
    }
}

TEST(Nnls, TheSmallFormEqualsTheGeneralOne) {
    // Random positive definite systems of which about half of the unknowns end at 0.
    constexpr std::size_t most = 8;
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    for (std::size_t n = 1; n <= most; ++n)
        for (int repetition = 0; repetition < 50; ++repetition) {
            const auto size = static_cast<Eigen::Index>(n);
            const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(size + 3, size, [&] { return normal(generator); });
            const Eigen::MatrixXd gram = a.transpose() * a;
            const Matrix rows(gram.data(), gram.data() + gram.size());
            SmallNnls<most>::Vector m{};
            for (std::size_t i = 0; i < n; ++i) m[i] = normal(generator);
            std::array<bool, most> free{};
            const auto small = SmallNnls<most>::solve(rows, m, n, free);
            const auto general = non_negative_least_squares(rows, std::span(m).first(n));
            for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(small[i], general[i], 1e-8 * (1 + general[i])) << n;
        }
}

}  // namespace
}  // namespace lobelia
