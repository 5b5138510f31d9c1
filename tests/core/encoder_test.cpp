// Tests each encoder: solvers against oracles, convergence of sequential encoders, and published figures on the
// published environment.
#include <gtest/gtest.h>

#include <map>

#include "core/math/least_squares.h"
#include "ennis.h"
#include "lobelia/codec.h"
#include "lobelia/encoders.h"
#include "support.h"

namespace lobelia {
namespace {

using LinearBasisPtr = std::shared_ptr<const LinearBasis>;
using EncoderPtr = std::shared_ptr<const Encoder>;

LinearBasisPtr linear_basis(const char* name) { return as_linear(make_basis(name).value()); }

std::vector<Rgb> encode_with(const EncoderPtr& encoder, SampleView samples) {
    Accumulator accumulator(encoder);
    accumulator.add(samples);
    return accumulator.solve();
}
std::vector<Rgb> encode_with(const char* encoder, const LinearBasisPtr& basis, SampleView samples) {
    return encode_with(make_encoder(encoder, basis).value(), samples);
}

/// A bright and a dim patch over a gradient: no basis here represents it exactly.
Rgb patches(Vec3 d) {
    const float a = dot(d, normalize(Vec3{1, 2, 3})), b = dot(d, normalize(Vec3{-2, 1, 1}));
    return {1 + d.x + 4 * std::exp(8 * (a - 1)), 0.5f + std::exp(8 * (a - 1)), 0.2f + 3 * std::exp(12 * (b - 1))};
}
Samples smooth(Domain domain, std::size_t count) { return test::samples_of(domain, count, patches); }

// ---- Least squares ----

TEST(LeastSquares, SampledGramEqualsQrOfTheDesignMatrix) {
    const Image sky = test::small_sky();
    for (const char* name : {"sg12", "sg12h", "sg5h", "sg24", "sh1", "sh2", "sh4", "sh8"}) {
        const LinearBasisPtr basis = linear_basis(name);
        for (const Samples& samples : {texel_samples(sky, basis->domain()), smooth(basis->domain(), 5000)}) {
            const auto expected = least_squares_by_qr(*basis, samples);
            EXPECT_LE(test::distance(encode_with("least-squares", basis, samples), expected),
                      1e-4 * test::norm(expected))
                << name;
        }
    }
}

TEST(LeastSquares, SampledGramEqualsQrOnEnnis) {
    SKIP_WITHOUT_ENNIS();
    const LinearBasisPtr basis = linear_basis("sg12");
    const Samples samples = texel_samples(test::ennis());
    const auto expected = least_squares_by_qr(*basis, samples);
    EXPECT_LE(test::distance(encode_with("least-squares", basis, samples), expected), 1e-4 * test::norm(expected));
}

TEST(LeastSquares, RecoversWhatIsInTheSpan) {
    for (const char* name : {"sg12", "sg12h", "sh3"}) {
        const LinearBasisPtr basis = linear_basis(name);
        std::vector<Rgb> truth(basis->size());
        for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = {1 + static_cast<float>(i), 0.5f, -2};
        const Directions directions = test::random_directions(basis->domain(), 2000, 3);
        Colours radiance(2000);
        evaluate(*basis, truth, directions, radiance);
        Samples samples(2000);
        for (std::size_t i = 0; i < 2000; ++i)
            samples.set(i, {direction_at(directions, i), colour_at(radiance, i), 1 + static_cast<float>(i % 7)});
        for (const char* encoder : {"least-squares", "matrix-gain", "regularised"}) {
            // The prior of the last two has weight n / (N + n) at most.
            const double tolerance = std::string(encoder) == "least-squares" ? 1e-4 : 0.05;
            EXPECT_LE(test::excess(*basis, encode_with(encoder, basis, samples), truth), tolerance) << name << encoder;
        }
    }
}

TEST(Moments, AnalyticGramConvergesToLeastSquares) {
    for (const char* name : {"sg12", "sg12h", "sh3"}) {
        const LinearBasisPtr basis = linear_basis(name);
        double previous = 1;
        for (const std::size_t count : {256, 1024, 4096, 16384}) {
            const Samples samples = smooth(basis->domain(), count);
            const double error =
                test::excess(*basis, encode_with("moments", basis, samples), least_squares_by_qr(*basis, samples));
            EXPECT_LT(error, 0.7 * previous) << name << " at " << count;
            previous = error;
        }
        EXPECT_LT(previous, 1e-3) << name;
    }
}

TEST(MatrixGain, ApproachesLeastSquares) {
    for (const char* name : {"sg12", "sg12h", "sh3"}) {
        const LinearBasisPtr basis = linear_basis(name);
        double previous = 1;
        for (const std::size_t count : {256, 1024, 4096, 16384}) {
            const Samples samples = smooth(basis->domain(), count);
            const double error =
                test::excess(*basis, encode_with("matrix-gain", basis, samples), least_squares_by_qr(*basis, samples));
            EXPECT_LT(error, previous) << name << " at " << count;
            previous = error;
        }
        // The start at 0 counts as n samples.
        EXPECT_LT(previous, 2.2 * static_cast<double>(basis->size()) / 16384) << name;
    }
}

TEST(Regularised, IsFiniteAndNoWorseThanItsNeighboursFromTheFirstSample) {
    // Compare it with the sampled and with the exact Gram matrix alone, averaged over 64 seeds.
    for (const char* name : {"sg12", "sg12h"}) {
        const LinearBasisPtr basis = linear_basis(name);
        const auto limit = encode_with("least-squares", basis, smooth(basis->domain(), 16384));
        std::map<std::string, double> total;
        for (std::size_t count = 1; count <= 16; ++count) {
            std::map<std::string, double> mean;
            for (std::uint32_t seed = 0; seed < 64; ++seed) {
                const Directions directions = test::random_directions(basis->domain(), count, seed);
                Samples samples(count);
                for (std::size_t i = 0; i < count; ++i)
                    samples.set(i, {direction_at(directions, i), patches(direction_at(directions, i)), 1});
                for (const char* encoder : {"regularised", "moments", "least-squares"}) {
                    const auto c = encode_with(encoder, basis, samples);
                    EXPECT_TRUE(test::all_finite(c));
                    mean[encoder] += test::excess(*basis, c, limit) / 64;
                }
            }
            EXPECT_LE(mean["regularised"], std::max(mean["moments"], mean["least-squares"])) << name << " " << count;
            for (const auto& [encoder, error] : mean) total[encoder] += error / 16;
        }
        EXPECT_LE(total["regularised"], total["moments"]) << name;
        EXPECT_LE(total["regularised"], total["least-squares"]) << name;
    }
}

// ---- Non-negative least squares ----

struct Problem {
    Matrix gram;
    std::vector<double> m;
};

/// G = A^T A of a random tall A (of about `rank` independent columns), m = A^T y.
Problem random_problem(std::size_t n, std::size_t rank, std::uint32_t seed) {
    std::mt19937 generator(seed);
    const auto value = [&] { return static_cast<double>(generator()) * 0x1p-31 - 1; };
    const std::size_t rows = 2 * n + 1;
    std::vector<double> a(rows * n), y(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        y[i] = value();
        for (std::size_t j = 0; j < n; ++j) a[i * n + j] = j < rank ? value() : a[i * n + j - rank] + 1e-4 * value();
    }
    Problem p{Matrix(n * n), std::vector<double>(n)};
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t r = 0; r < rows; ++r) {
            p.m[i] += a[r * n + i] * y[r];
            for (std::size_t j = 0; j < n; ++j) p.gram[i * n + j] += a[r * n + i] * a[r * n + j];
        }
    return p;
}

double objective(const Problem& p, const std::vector<double>& b) {
    const std::size_t n = b.size();
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        sum -= 2 * p.m[i] * b[i];
        for (std::size_t j = 0; j < n; ++j) sum += b[i] * p.gram[i * n + j] * b[j];
    }
    return sum;
}

/// Solves the rows and columns of `set` by Gauss-Jordan elimination with pivoting; zeros elsewhere.
std::vector<double> solve_on(const Problem& p, const std::vector<std::size_t>& set) {
    const std::size_t n = p.m.size(), k = set.size();
    std::vector<std::vector<double>> a(k, std::vector<double>(k + 1));
    for (std::size_t i = 0; i < k; ++i) {
        for (std::size_t j = 0; j < k; ++j) a[i][j] = p.gram[set[i] * n + set[j]];
        a[i][k] = p.m[set[i]];
    }
    for (std::size_t c = 0; c < k; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < k; ++r)
            if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
        std::swap(a[c], a[pivot]);
        for (std::size_t r = 0; r < k; ++r) {
            if (r == c) continue;
            const double f = a[r][c] / a[c][c];
            for (std::size_t j = c; j <= k; ++j) a[r][j] -= f * a[c][j];
        }
    }
    std::vector<double> b(n);
    for (std::size_t i = 0; i < k; ++i) b[set[i]] = a[i][k] / a[i][i];
    return b;
}

TEST(NonNegativeLeastSquares, EqualsTheEnumerationOfActiveSets) {
    for (std::size_t n = 1; n <= 6; ++n)
        for (std::uint32_t seed = 0; seed < 60; ++seed) {
            const Problem p = random_problem(n, n, 100 * seed + static_cast<std::uint32_t>(n));
            std::vector<double> best(n);
            double least = 0;
            for (std::size_t mask = 1; mask < (std::size_t{1} << n); ++mask) {
                std::vector<std::size_t> set;
                for (std::size_t i = 0; i < n; ++i)
                    if (mask >> i & 1) set.push_back(i);
                const auto b = solve_on(p, set);
                if (std::any_of(b.begin(), b.end(), [](double v) { return v < 0; })) continue;
                if (objective(p, b) < least) {
                    least = objective(p, b);
                    best = b;
                }
            }
            const auto found = non_negative_least_squares(p.gram, p.m);
            EXPECT_NEAR(objective(p, found), least, 1e-12) << n << " seed " << seed;
            for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i], best[i], 1e-9) << n << " seed " << seed;
        }
}

TEST(NonNegativeLeastSquares, SatisfiesTheKarushKuhnTuckerConditions) {
    for (const std::size_t n : {1, 3, 12, 25, 60})
        for (const std::size_t rank : {n, (n + 1) / 2})
            for (std::uint32_t seed = 0; seed < 10; ++seed) {
                const Problem p = random_problem(n, rank, seed);
                const auto b = non_negative_least_squares(p.gram, p.m);
                double scale = 0;
                for (const double m : p.m) scale = std::max(scale, std::abs(m));
                for (std::size_t i = 0; i < n; ++i) {
                    double gradient = p.m[i];
                    for (std::size_t j = 0; j < n; ++j) gradient -= p.gram[i * n + j] * b[j];
                    ASSERT_GE(b[i], 0);
                    EXPECT_LE(gradient, 1e-7 * scale) << n << " rank " << rank << " seed " << seed;
                    if (b[i] > 0) {
                        EXPECT_GE(gradient, -1e-7 * scale) << n << " rank " << rank << " seed " << seed;
                    }
                }
            }
}

TEST(NonNegativeLeastSquares, OfNothingToGainIsZero) {
    const Problem p = random_problem(5, 5, 1);
    std::vector<double> down(5, -1.0), zero(5, 0.0);
    EXPECT_EQ(non_negative_least_squares(p.gram, down), zero);
    EXPECT_EQ(non_negative_least_squares(p.gram, zero), zero);
}

TEST(NonNegativeLeastSquares, IsLeastSquaresWhereThatIsNonNegative) {
    const LinearBasisPtr basis = linear_basis("sg12");
    const Samples bright = test::samples_of(Domain::sphere, 4096, [](Vec3 d) { return Rgb{3 + d.x, 2, 3 + d.y}; });
    const auto expected = encode_with("least-squares", basis, bright);
    for (const Rgb& v : expected) ASSERT_GT(std::min({v.r, v.g, v.b}), 0);
    EXPECT_LE(test::distance(encode_with("nnls", basis, bright), expected), 1e-5 * test::norm(expected));
}

// ---- The joint norm ----

/// Root mean square error of irradiance against the exact sum over samples, at 300 normals.
double irradiance_error(const LinearBasis& basis, const std::vector<Rgb>& c, SampleView samples) {
    const Directions normals = test::random_directions(Domain::sphere, 300, 9);
    Colours found(300), expected(300);
    irradiance(*basis.evaluator(basis.evaluator_names().back()), c, normals, found);
    irradiance_sum(samples, normals, expected);
    double squares = 0;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 300; ++i) squares += std::pow(found.channel(k)[i] - expected.channel(k)[i], 2);
    return std::sqrt(squares / 900);
}

TEST(JointNorm, OfWeightZeroIsTheRegularisedForm) {
    for (const char* name : {"sg12", "sg12h", "sh2"})
        for (const std::size_t count : {5, 100, 4096}) {
            const LinearBasisPtr basis = linear_basis(name);
            const Samples samples = smooth(basis->domain(), count);
            const auto expected = encode_with("regularised", basis, samples);
            const auto joint =
                encode_with(make_moment_encoder(basis, MomentSolver::joint, {.irradiance_weight = 0}), samples);
            EXPECT_LE(test::excess(*basis, joint, expected), 1e-6) << name << " " << count;
        }
}

TEST(JointNorm, GivesUpRadianceForIrradianceAsItsWeightGrows) {
    const LinearBasisPtr basis = linear_basis("sg12");
    const Samples samples = texel_samples(test::small_sky());
    const auto limit = encode_with("least-squares", basis, samples);
    for (const auto solver : {MomentSolver::joint, MomentSolver::joint_non_negative}) {
        double previous_irradiance = HUGE_VAL, previous_radiance = -1;
        for (const double weight : {0.0, 0.1, 1.0, 10.0}) {
            const auto c = encode_with(make_moment_encoder(basis, solver, {.irradiance_weight = weight}), samples);
            const double error = irradiance_error(*basis, c, samples), radiance = test::excess(*basis, c, limit);
            EXPECT_LT(error, previous_irradiance) << weight;
            EXPECT_GT(radiance, previous_radiance) << weight;
            previous_irradiance = error;
            previous_radiance = radiance;
        }
    }
}

// ---- Progressive least squares ----

TEST(Progressive, EveryPublishedChoiceConverges) {
    using Denominator = ProgressiveOptions::Denominator;
    const LinearBasisPtr basis = linear_basis("sg12");
    const auto limit = encode_with("least-squares", basis, smooth(Domain::sphere, 16384));
    std::map<std::string, ProgressiveOptions> choices;
    choices["clamped"] = {};
    choices["sampled"].denominator = Denominator::sampled;
    choices["sampled, first given"].denominator = Denominator::sampled;
    choices["sampled, first given"].first_mean_square = 0.04f;
    choices["exact"].denominator = Denominator::exact;
    choices["ramp"].ramp = 100;
    choices["seed"].seed = encode_with("progressive", basis, smooth(Domain::sphere, 256));
    choices["accelerated"].acceleration = 3;
    for (const auto& [name, options] : choices) {
        const EncoderPtr encoder = make_progressive(basis, Sign::any, options);
        const auto error = [&](std::size_t count) {
            return test::excess(*basis, encode_with(encoder, smooth(Domain::sphere, count)), limit);
        };
        EXPECT_LT(error(16384), 0.7 * error(256)) << name;
        EXPECT_LT(error(16384), 0.05) << name;

        // The non-negative form stays non-negative, and converges to a solution as good as least squares with b >= 0.
        const auto c = encode_with(make_progressive(basis, Sign::non_negative, options), smooth(Domain::sphere, 16384));
        for (const Rgb& v : c) EXPECT_GE(std::min({v.r, v.g, v.b}), 0) << name;
        EXPECT_LT(test::excess(*basis, c, encode_with("nnls", basis, smooth(Domain::sphere, 16384))), 0.05) << name;
    }
}

TEST(Progressive, FirstSampleOfAnExactDenominatorIsItsFormula) {
    // b_i = v w_i / S_i, S_i the mean of B_i^2: (1 - e^(-4 lambda)) / (4 lambda).
    const LinearBasisPtr basis = linear_basis("sg12");
    ProgressiveOptions options;
    options.denominator = ProgressiveOptions::Denominator::exact;
    Samples one(1);
    one.set(0, {normalize(Vec3{1, -1, 0.5f}), {2, 0, 1}, 0.3f});
    const auto c = encode_with(make_progressive(basis, Sign::any, options), one);
    std::vector<float> rows(basis->size() * k_block_size);
    basis->values(one.view().directions(), rows.data());
    const double mean_square = -std::expm1(-4 * 6.0) / (4 * 6.0);
    for (std::size_t i = 0; i < c.size(); ++i)
        EXPECT_NEAR(c[i].r, 2 * rows[i * k_block_size] / mean_square, 1e-5 * (1 + std::abs(c[i].r))) << i;
}

TEST(RunningAverage, IsItsFormula) {
    const LinearBasisPtr basis = linear_basis("sg5h");
    const Samples samples = smooth(Domain::hemisphere, 50);
    std::vector<double> mu(5), sum(5);
    std::vector<float> rows(5 * k_block_size);
    basis->values(samples.view().directions(), rows.data());
    for (std::size_t j = 0; j < samples.size(); ++j) {
        double est = 0;
        for (std::size_t i = 0; i < 5; ++i) est += mu[i] * rows[i * k_block_size + j];
        const double delta = samples[j].radiance.g - est;
        for (std::size_t i = 0; i < 5; ++i) {
            sum[i] += rows[i * k_block_size + j];
            mu[i] += delta * rows[i * k_block_size + j] / sum[i];
        }
    }
    const auto c = encode_with("running-average", basis, samples);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(c[i].g, mu[i], 1e-4 * std::abs(mu[i])) << i;
}

// ---- The published environment ----

/// Mean over seeds of the excess error, against each encoder's own limit, after the first `count` shuffled texels.
class EnnisConvergence {
  public:
    explicit EnnisConvergence(const char* basis) : basis_(linear_basis(basis)) {
        for (std::uint32_t seed = 0; seed < 32; ++seed)
            orders_.push_back(shuffled_texel_samples(test::ennis(), basis_->domain(), seed));
    }
    [[nodiscard]] double operator()(const std::string& encoder, std::size_t count) {
        if (!limits_.contains(encoder))
            limits_[encoder] = encode_with(encoder_limit(encoder).c_str(), basis_, orders_[0]);
        double sum = 0;
        for (const Samples& order : orders_)
            sum += test::excess(*basis_, encode_with(encoder.c_str(), basis_, order.view().part(0, count)),
                                limits_[encoder]);
        return sum / static_cast<double>(orders_.size());
    }

  private:
    LinearBasisPtr basis_;
    std::vector<Samples> orders_;
    std::map<std::string, std::vector<Rgb>> limits_;
};

TEST(EnnisConvergence, NewEncodersHaveAtMostHalfTheExcessOfProgressiveFrom1024Samples) {
    SKIP_WITHOUT_ENNIS();
    for (const char* basis : {"sg12", "sg12h"}) {
        EnnisConvergence excess(basis);
        for (const std::size_t count : {1024, 2048, 4096, 16384}) {
            const double progressive = excess("progressive", count);
            for (const char* encoder : {"matrix-gain", "regularised", "nnls"})
                EXPECT_LE(excess(encoder, count), progressive / 2) << basis << " " << encoder << " at " << count;
        }
    }
}

TEST(EnnisConvergence, RegularisedIsNeverWorseThanProgressiveFrom16Samples) {
    SKIP_WITHOUT_ENNIS();
    for (const char* basis : {"sg12", "sg12h"}) {
        EnnisConvergence excess(basis);
        for (const std::size_t count : {16, 32, 48, 64, 96, 128, 256, 512, 1024, 2048, 4096})
            EXPECT_LE(excess("regularised", count), excess("progressive", count)) << basis << " at " << count;
    }
}

TEST(EnnisFigures, AreThoseOfTheReference) {
    SKIP_WITHOUT_ENNIS();
    // RMS errors weighted by solid angle. Irradiance over pi is divided by the mean radiance, with exact E for
    // Gaussians, and harmonics clamped at 0.
    const Samples texels = texel_samples(test::ennis());
    const SampleView view = texels;
    Colours reference(2048);
    const LatLong grid{64, 32};
    const Directions normals = grid.directions();
    irradiance_sum(texels, normals, reference);
    const Rgb mean = mean_radiance(test::ennis());
    struct Figures {
        double radiance, irradiance;
    };
    const auto measure = [&](const LinearBasisPtr& basis, const EncoderPtr& encoder) {
        const Codec codec({}, encoder, basis->evaluator(basis->is_non_negative() ? "exact" : "convolution"));
        const auto c = codec.encode(texels);
        Colours L(texels.size()), E(2048);
        codec.radiance(c, view.directions(), L);
        codec.irradiance(c, normals, E);
        const auto rms = [](ColourView a, ColourView b, const auto& weight) {
            double sum = 0, total = 0;
            for (std::size_t i = 0; i < a.size; ++i) {
                total += 3 * weight(i);
                for (std::size_t k = 0; k < 3; ++k)
                    sum += weight(i) * std::pow(static_cast<double>(a.channel(k)[i]) - b.channel(k)[i], 2);
            }
            return std::sqrt(sum / total);
        };
        const double L_mean = (mean.r + mean.g + mean.b) / 3.0;
        return Figures{
            rms(L, view.radiance(), [&](std::size_t i) { return double{view.solid_angles()[i]}; }),
            rms(E, reference, [&](std::size_t i) { return grid.solid_angle(i / grid.width); }) / k_pi / L_mean};
    };
    const LinearBasisPtr sg12 = linear_basis("sg12");
    const auto joint = [&](MomentSolver solver, double weight) {
        return measure(sg12, make_moment_encoder(sg12, solver, {.irradiance_weight = weight}));
    };
    const Figures plain = measure(sg12, make_encoder("least-squares", sg12).value());
    EXPECT_NEAR(plain.radiance, 4.557, 5e-4);
    EXPECT_NEAR(plain.irradiance, .158, 5e-4);
    EXPECT_NEAR(joint(MomentSolver::joint, 0).radiance, 4.5565, 1e-3);
    EXPECT_NEAR(joint(MomentSolver::joint, 1).radiance, 4.5648, 1e-3);
    EXPECT_NEAR(joint(MomentSolver::joint, 1).irradiance, .087, 5e-4);
    EXPECT_NEAR(joint(MomentSolver::joint, 10).radiance, 4.592, 1e-3);
    EXPECT_NEAR(joint(MomentSolver::joint, 10).irradiance, .051, 5e-4);
    EXPECT_NEAR(measure(sg12, make_encoder("nnls", sg12).value()).irradiance, .567, 5e-4);
    EXPECT_NEAR(joint(MomentSolver::joint_non_negative, 1).irradiance, .251, 5e-4);
    const std::map<const char*, Figures> harmonics = {{"sh1", {0, .385}}, {"sh2", {5.407, .0743}}, {"sh4", {0, .0223}}};
    for (const auto& [name, printed] : harmonics) {
        const LinearBasisPtr basis = linear_basis(name);
        const Figures found = measure(basis, make_encoder("projection", basis).value());
        if (printed.radiance > 0) {
            EXPECT_NEAR(found.radiance, printed.radiance, 5e-4) << name;
        }
        EXPECT_NEAR(found.irradiance, printed.irradiance, printed.irradiance > .1 ? 5e-4 : 5e-5) << name;
    }
}

}  // namespace
}  // namespace lobelia
