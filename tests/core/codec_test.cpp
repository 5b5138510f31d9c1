// Conformance tests of every codec in the list, and of a few bases beyond it. A basis, encoder or evaluator added to
// the catalogue is tested here without further code; a trace names the one that fails.
#include "lobelia/codec.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

#include "core/basis/sg/sg_irradiance.h"
#include "core/basis/sg/spherical_gaussians.h"
#include "core/math/least_squares.h"
#include "lobelia/encoders.h"
#include "support.h"

namespace lobelia {
namespace {

using BasisPtr = std::shared_ptr<const Basis>;
using EncoderPtr = std::shared_ptr<const Encoder>;

const std::vector<BasisPtr>& bases() {
    static const std::vector<BasisPtr> list = [] {
        std::vector<std::string> names = basis_names();
        for (const char* unlisted : {"sg24", "sg12a", "sg5h", "sg1"}) names.emplace_back(unlisted);
        std::vector<BasisPtr> result;
        for (const auto& name : names) result.push_back(make_basis(name).value());
        return result;
    }();
    return list;
}

using ForEncoder = std::function<void(const BasisPtr&, const std::string&, const EncoderPtr&)>;

/// Returns a listed encoder, made once: some need quadratures to set up.
const EncoderPtr& encoder_of(const BasisPtr& basis, const std::string& name) {
    static std::map<std::pair<std::string, std::string>, EncoderPtr> made;
    EncoderPtr& encoder = made[{basis->name(), name}];
    if (!encoder) encoder = make_encoder(name, basis).value();
    return encoder;
}

/// Returns whether samples that differ by rounding give coefficients that differ by rounding. False for searches of
/// lobes.
bool is_continuous(const Basis& basis) { return !basis.fitted() || basis.fitted()->is_continuous(); }

/// Calls `run` for every basis with every compatible encoder.
void for_each_encoder(const ForEncoder& visit) {
    for (const BasisPtr& basis : bases())
        for (const auto& name : encoder_names(*basis)) {
            SCOPED_TRACE(basis->name() + "/" + name);
            visit(basis, name, encoder_of(basis, name));
        }
}

std::vector<Rgb> encode(const EncoderPtr& encoder, SampleView samples) {
    Accumulator accumulator(encoder);
    accumulator.add(samples);
    return accumulator.solve();
}

Colours radiance_of(const Basis& basis, std::span<const Rgb> c, const Directions& directions) {
    Colours out(directions.size());
    basis.radiance(c, directions, out);
    return out;
}

Colours irradiance_of(const Evaluator& evaluator, std::span<const Rgb> c, const Directions& normals) {
    Colours out(normals.size());
    irradiance(evaluator, c, normals, out);
    return out;
}

/// The coefficients of least squares over the samples, by QR where there are not too many.
std::vector<Rgb> best_fit(const BasisPtr& basis, SampleView samples) {
    const auto linear = basis->linear() ? as_linear(basis) : basis->fitted()->accumulated();
    if (linear->size() > 300) return encode(encoder_of(basis, encoder_names(*basis).front()), samples);
    if (linear->size() > 100) return encode(encoder_of(basis, "least-squares"), samples);
    const auto best = least_squares_by_qr(*linear, samples);
    if (basis->linear()) return best;
    std::vector<Rgb> c(basis->size());
    basis->fitted()->fit(best, c);
    return c;
}

/// |a - b| / |b| of the radiance of two coefficient vectors: exact by the Gram matrix, or at many directions.
double excess(const Basis& basis, const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    if (basis.linear()) return test::excess(*basis.linear(), a, b);
    const Directions directions = uniform_directions(basis.domain(), Sequence::sobol, 1024, 21);
    const Colours of_a = radiance_of(basis, a, directions), of_b = radiance_of(basis, b, directions);
    double difference = 0, size = 0;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < directions.size(); ++i) {
            difference += std::pow(of_a.channel(k)[i] - of_b.channel(k)[i], 2);
            size += std::pow(of_b.channel(k)[i], 2);
        }
    return std::sqrt(difference / size);
}

/// Returns whether all functions are known to be >= 0.
bool is_non_negative(const Basis& basis) { return basis.linear() && basis.linear()->is_non_negative(); }

/// A sky with its sun: radiances from 0.01 to thousands.
Samples sky_samples(Domain domain, std::size_t count, Sequence sequence = Sequence::sobol) {
    static const Image image = test::small_sky();
    const Samples samples = directed_samples(image, uniform_directions(domain, sequence, count, 3), domain);
    std::mt19937 generator(5);
    return reordered(samples, shuffled_order(count, generator));
}

/// Normals whose light all comes from the domain: any normal for the sphere, only z for the hemisphere.
Directions inner_normals(Domain domain) {
    if (domain == Domain::sphere) return test::random_directions(domain, 100, 6);
    Directions up(1);
    set_entry(up.view(), 0, Vec3{0, 0, 1});
    return up;
}

// ---- Environments with known answers ----

constexpr std::size_t k_furnace_samples = 16384;

/// Largest bias of an encoder, as RMS radiance beyond the least-squares fit, for an environment of radiance 1 or 1 +
/// 0.5 d . a after k_furnace_samples shuffled Sobol samples. Each value is measured and rounded up by about a third. K
/// is the number of coefficients.
double bias(const std::string& encoder, const Basis& basis) {
    const double k = static_cast<double>(basis.size()), share = k / k_furnace_samples;
    const std::map<std::string, double> biases = {
        // Projection ignores the overlap of functions and keeps only the total energy; exact for orthonormal functions.
        {"projection", is_non_negative(basis) ? 0.4 : 1e-3},
        // Running averages divide each lobe by its own sum of weights: not least squares, and broad lobes take from
        // narrow ones.
        {"running-average", 0.08},
        {"running-average-nn", 0.08},
        // Progressive encoders converge as n^-mu, where mu is the least eigenvalue of the unit-diagonal Gram matrix.
        // With many functions the first K samples overshoot by up to K / n each, and that error decays only as 1 / n.
        {"progressive", k > 36 ? 0.7 : 0.1},
        {"progressive-nn", 0.1},
        // The moments of the samples differ from those of the domain by the error of the sequence.
        {"moments", k > 100                  ? 0.04
                    : basis.name() == "oct8" ? 0.015
                                             : 1e-3},
        // Exact except for float32 sums, if all coefficients of the fit are positive.
        {"least-squares", 1e-5},
        {"nnls", 0.06},
        // The prior, a constant environment, has weight K / (N + K) at most, and an error of 0.5 d . a.
        {"regularised", 1e-5 + 0.6 * share},
        // The prior b = 0 has weight K / (N + K).
        {"matrix-gain", 2.2 * share},
        // The joint norm trades radiance error for irradiance error.
        {"joint", 0.045},
        {"joint-nn", 0.06},
    };
    const auto found = biases.find(encoder);
    return found == biases.end() ? 0 : found->second;  // 0: a new encoder states its own here
}

/// Largest error of E / pi that an evaluator states for these coefficients; nothing if a lobe is outside its range.
std::optional<double> stated_error(const Basis& basis, const std::string& evaluator, const std::vector<Rgb>& c) {
    const auto* gaussians = dynamic_cast<const SphericalGaussians*>(&basis);
    if (!gaussians) return 1e-6 * test::norm(c);
    const auto& info = sg_irradiance_list()[static_cast<std::size_t>(*sg_irradiance_from_name(evaluator))];
    double error = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const double s = gaussians->lobes()[i].sharpness;
        if (s == 0) continue;
        if (s < info.low || s > info.high) return std::nullopt;
        error += std::abs(c[i].g) * info.error * gaussian::integral(s) / k_pi;
    }
    return error;
}

/// Radiance 1 + slope d . a, in green; half of it in red, nothing in blue.
struct LinearEnvironment {
    float slope = 0;
    Vec3 a = normalize(Vec3{0.3f, 0.5f, 0.8f});
    [[nodiscard]] float radiance(Vec3 d) const { return 1 + slope * dot(a, d); }
    /// E / pi at normals whose hemisphere is within the domain.
    [[nodiscard]] float irradiance_over_pi(Vec3 n) const { return 1 + slope * 2 / 3 * dot(a, n); }
    [[nodiscard]] Samples samples(Domain domain) const {
        return test::samples_of(domain, k_furnace_samples, [&](Vec3 d) {
            const float L = radiance(d);
            return Rgb{L / 2, L, 0};
        });
    }
};

double rms_of_radiance(const Colours& colours, const LinearEnvironment& environment, const Directions& directions) {
    double squares = 0;
    for (std::size_t i = 0; i < directions.size(); ++i)
        squares += std::pow(colours.channel(1)[i] - environment.radiance(direction_at(directions, i)), 2);
    return std::sqrt(squares / static_cast<double>(directions.size()));
}

double worst_of_irradiance(const Colours& colours, const LinearEnvironment& environment, const Directions& normals) {
    double worst = 0;
    for (std::size_t i = 0; i < normals.size(); ++i)
        worst = std::max(
            worst, std::abs(colours.channel(1)[i] / k_pi - environment.irradiance_over_pi(direction_at(normals, i))));
    return worst;
}

/// Returns the most accurate evaluator of a basis: the last for Gaussians, the signed one for harmonics.
std::shared_ptr<const Evaluator> exact_evaluator(const Basis& basis) {
    return basis.evaluator(basis.evaluator_names().back());
}

/// Checks every codec against the best fit of its basis, within the encoder's bias and the evaluator's stated error.
void expect_environment(const LinearEnvironment& environment) {
    for (const BasisPtr& basis : bases()) {
        const Domain domain = basis->domain();
        const Directions directions = test::random_directions(domain, 400, 77);
        const Directions normals = inner_normals(domain);
        const Samples samples = environment.samples(domain);
        const auto best = best_fit(basis, samples);
        const double best_rms = rms_of_radiance(radiance_of(*basis, best, directions), environment, directions);
        const double best_worst =
            worst_of_irradiance(irradiance_of(*exact_evaluator(*basis), best, normals), environment, normals);
        for (const auto& name : encoder_names(*basis)) {
            SCOPED_TRACE(basis->name() + "/" + name);
            const auto c = encode(encoder_of(basis, name), samples);

            // Check the radiance.
            const double allowed = bias(name, *basis);
            const Colours radiance = radiance_of(*basis, c, directions);
            EXPECT_LE(rms_of_radiance(radiance, environment, directions), best_rms + allowed);
            // Check that channels do not mix; a fitted basis that shares data among channels may mix them by little
            // more than its error.
            double mixing = 0, from_nothing = 0;
            for (std::size_t i = 0; i < directions.size(); ++i) {
                mixing = std::max(mixing, std::abs(radiance.channel(0)[i] - radiance.channel(1)[i] / 2.0));
                from_nothing = std::max(from_nothing, std::abs(static_cast<double>(radiance.channel(2)[i])));
            }
            EXPECT_LE(mixing, basis->linear() ? 1e-4 : 1e-4 + 20 * (best_rms + allowed));
            EXPECT_LE(from_nothing, basis->linear() ? 1e-6 : 1e-4 + 20 * (best_rms + allowed));

            // Check the irradiance of all evaluators: the limit is the error of the best coefficients, the bias, and
            // the evaluator's stated error. E / pi is a mean of radiances, so its error is at most half more than their
            // RMS error.
            for (const auto& evaluator_name : basis->evaluator_names()) {
                const Colours E = irradiance_of(*basis->evaluator(evaluator_name), c, normals);
                EXPECT_TRUE(test::all_finite(E)) << evaluator_name;
                // Evaluators that are models of their own must only reproduce a constant environment.
                const Accuracy accuracy = basis->evaluator(evaluator_name)->accuracy();
                const bool own = accuracy.reading == Reading::of_its_own;
                const auto stated = own ? std::optional(accuracy.furnace) : stated_error(*basis, evaluator_name, c);
                if (!stated || (own && environment.slope != 0)) continue;
                EXPECT_LE(worst_of_irradiance(E, environment, normals), best_worst + 1.5 * allowed + *stated)
                    << evaluator_name;
            }
        }
    }
}

TEST(EveryCodec, WhiteFurnace) { expect_environment({.slope = 0}); }

TEST(EveryCodec, WhiteFurnaceOfTheBestFitIsAsStated) {
    for (const auto& name : basis_names()) {
        const BasisPtr basis = make_basis(name).value();
        const auto c = best_fit(basis, LinearEnvironment{}.samples(basis->domain()));
        const Directions normals = inner_normals(basis->domain());
        for (const auto& evaluator_name : basis->evaluator_names()) {
            const auto evaluator = basis->evaluator(evaluator_name);
            const bool own = evaluator->accuracy().reading == Reading::of_its_own;
            const auto stated = own ? evaluator->accuracy().furnace : stated_error(*basis, evaluator_name, c);
            if (!stated) continue;
            EXPECT_LE(worst_of_irradiance(irradiance_of(*evaluator, c, normals), {}, normals),
                      card_of(*basis).furnace_bias + *stated)
                << name << " " << evaluator_name;
        }
    }
}

TEST(EveryCodec, LinearSky) { expect_environment({.slope = 0.5f}); }

TEST(EveryCodec, WhiteFurnaceIsExactWhereAConstantIsInTheSpan) {
    for (const BasisPtr& basis : bases()) {
        const Samples samples = LinearEnvironment{}.samples(basis->domain());
        const Directions directions = test::random_directions(basis->domain(), 100, 5);
        const double best =
            rms_of_radiance(radiance_of(*basis, best_fit(basis, samples), directions), LinearEnvironment{}, directions);
        if (best > 1e-6) {
            for (const char* known : {"sh1", "sh2", "sh8", "sg12a"}) EXPECT_NE(basis->name(), known);
            continue;
        }
        for (const auto& name : encoder_names(*basis)) {
            if (name != "least-squares" && name != "regularised" && name != "joint") continue;
            EXPECT_LT(rms_of_radiance(radiance_of(*basis, encode(encoder_of(basis, name), samples), directions),
                                      LinearEnvironment{}, directions),
                      1e-5)
                << basis->name() << "/" << name;
        }
    }
}

TEST(EveryCodec, ProjectionKeepsTheEnergyOfAConstant) {
    for (const BasisPtr& basis : bases()) {
        if (!basis->linear()) continue;
        const auto c = encode(encoder_of(basis, "projection"), LinearEnvironment{}.samples(basis->domain()));
        const auto integrals = basis->linear()->integrals();
        double energy = 0;
        for (std::size_t i = 0; i < c.size(); ++i) energy += c[i].g * integrals[i];
        EXPECT_NEAR(energy, solid_angle(basis->domain()), 1e-3 * solid_angle(basis->domain())) << basis->name();
    }
}

// ---- Rotation ----

TEST(EveryCodec, RotatedCoefficientsAreTheRotatedFunction) {
    for (const BasisPtr& basis : bases()) {
        const Domain domain = basis->domain();
        const Rotation r = domain == Domain::sphere ? test::some_rotation() : test::about_z(0.8);
        const auto c = encode(encoder_of(basis, "least-squares"), sky_samples(domain, 2048));
        const auto rotated = basis->rotated(r, c);
        ASSERT_EQ(rotated.c.size(), c.size());
        EXPECT_EQ(rotated.basis->domain(), domain);
        const Directions directions = test::random_directions(domain, 200, 9);
        const Colours before = radiance_of(*basis, c, directions);
        const Colours after = radiance_of(*rotated.basis, rotated.c, test::turned(directions, r));
        EXPECT_LE(test::largest_difference(before, after), 2e-5 * test::largest(before)) << basis->name();
        for (const auto& name : basis->evaluator_names()) {
            const Colours e = irradiance_of(*basis->evaluator(name), c, directions);
            const Colours turned =
                irradiance_of(*rotated.basis->evaluator(name), rotated.c, test::turned(directions, r));
            EXPECT_LE(test::largest_difference(e, turned), 2e-5 * test::largest(e)) << basis->name() << " " << name;
        }
    }
}

TEST(EveryCodec, RotationEquivariance) {
    for_each_encoder([](const BasisPtr& basis, const std::string& name, const EncoderPtr& encoder) {
        // Progressive encoders treat coefficients one by one. They are equivariant if the functions rotate with the
        // samples, as lobes do, but not if coefficients mix, as in harmonics.
        if (name.starts_with("progressive") && !is_non_negative(*basis)) return;
        const Domain domain = basis->domain();
        const Rotation r = domain == Domain::sphere ? test::some_rotation() : test::about_z(0.8);
        const Samples samples = sky_samples(domain, 2000);
        const auto c = encode(encoder, samples);
        const auto expected = basis->rotated(r, c);
        const auto found = encode(*make_encoder(name, expected.basis), test::turned(samples, r));
        EXPECT_LE(test::distance(found, expected.c), 1e-4 * test::norm(expected.c));
    });
}

// ---- Accumulating ----

TEST(EveryCodec, MergeEqualsSequential) {
    for_each_encoder([](const BasisPtr& basis, const std::string& name, const EncoderPtr& encoder) {
        if (!is_continuous(*basis)) return;
        const Samples samples = sky_samples(basis->domain(), 4096);
        const auto whole = encode(encoder, samples);
        const auto merged = [&](std::vector<std::size_t> cuts) {
            Accumulator result(encoder);
            cuts.push_back(samples.size());
            std::size_t begin = 0;
            for (const std::size_t end : cuts) {
                Accumulator part(encoder);
                part.add(test::slice(samples, begin, end));
                result.merge(part);
                begin = end;
            }
            return result.solve();
        };
        if (encoder->merging() == Merging::exact) {
            EXPECT_LE(excess(*basis, merged({2048}), whole), 2e-5);
            EXPECT_LE(excess(*basis, merged({7, 1000, 1001, 3333}), whole), 2e-5);
        } else if (basis->size() <= 36) {
            // Averages of estimates lag behind one pass: they may be this much further from the solution. (Beyond 36
            // coefficients the overshoot of the first samples dominates, and each part has its own.)
            const auto limit = encode(encoder_of(basis, encoder_limit(name)), samples);
            const double sequential = excess(*basis, whole, limit);
            EXPECT_LE(excess(*basis, merged({2048}), limit), 2.5 * sequential + 0.02);
        }
        EXPECT_TRUE(test::all_finite(merged({1, 2, 3})));
    });
}

TEST(EveryCodec, MergingWithNothingChangesNothing) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        Accumulator some(encoder), nothing(encoder), other(encoder);
        some.add(sky_samples(basis->domain(), 300));
        const auto before = some.solve();
        some.merge(nothing);
        EXPECT_LE(test::distance(some.solve(), before), 1e-6 * test::norm(before));
        other.merge(some);
        EXPECT_LE(test::distance(other.solve(), before), 1e-6 * test::norm(before));
        nothing.merge(Accumulator(encoder));
        EXPECT_EQ(test::norm(nothing.solve()), 0);
    });
}

TEST(EveryCodec, PiecesOfAnySizeEqualOneBatch) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        if (!is_continuous(*basis)) return;
        const Samples samples = sky_samples(basis->domain(), 700);
        const auto expected = encode(encoder, samples);
        for (const auto& sizes :
             std::vector<std::vector<std::size_t>>{{1}, {15, 16, 17}, {255, 256, 257}, {1, 500, 3}, {0, 699}}) {
            Accumulator accumulator(encoder);
            std::size_t begin = 0;
            for (std::size_t k = 0; begin < samples.size(); ++k) {
                const std::size_t end = std::min(samples.size(), begin + sizes[k % sizes.size()]);
                accumulator.add(test::slice(samples, begin, end));
                begin = end;
            }
            // The sums are equal except for float32 rounding, a few 1e-6 for 700 single samples. The condition number
            // of a fit to a sun multiplies it, most for an ambient lobe that is nearly a sum of the others.
            EXPECT_LE(excess(*basis, accumulator.solve(), expected), 2e-4) << "pieces from " << sizes[0];
        }
    });
}

TEST(EveryCodec, ACommonFactorInSolidAnglesIsHarmless) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        if (!is_continuous(*basis)) return;
        const Samples samples = sky_samples(basis->domain(), 1000);
        const auto expected = encode(encoder, samples);
        for (const float factor : {0.001f, 8.0f, 12345.6f}) {
            Samples scaled(samples.size());
            for (std::size_t i = 0; i < samples.size(); ++i) {
                RadianceSample s = samples[i];
                s.solid_angle *= factor;
                scaled.set(i, s);
            }
            EXPECT_LE(excess(*basis, encode(encoder, scaled), expected), 1e-4) << factor;
        }
    });
}

TEST(EveryCodec, AFactorInRadianceIsAFactorInCoefficients) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        const Samples samples = sky_samples(basis->domain(), 1000);
        const auto expected = encode(encoder, samples);
        for (const float factor : {0.25f, 1024.0f}) {
            Samples scaled(samples.size());
            for (std::size_t i = 0; i < samples.size(); ++i) {
                RadianceSample s = samples[i];
                s.radiance = s.radiance * factor;
                scaled.set(i, s);
            }
            auto found = encode(encoder, scaled);
            for (std::size_t i = 0; i < found.size(); ++i)
                if (basis->meanings()[i] == Meaning::light) found[i] = found[i] * (1 / factor);
            EXPECT_LE(excess(*basis, found, expected), 1e-5) << factor;
        }
    });
}

// ---- Signs and edges ----

TEST(EveryCodec, NonNegativeStaysNonNegative) {
    int tested = 0;
    for_each_encoder([&](const BasisPtr& basis, const std::string& name, const EncoderPtr& encoder) {
        EXPECT_EQ(encoder->is_non_negative(), name.ends_with("-nn") || name == "nnls");
        if (!encoder->is_non_negative()) return;
        ++tested;
        for (const std::size_t count : {1, 2, 10, 100, 2000}) {
            const auto c = encode(encoder, sky_samples(basis->domain(), count, Sequence::random));
            for (const Rgb& v : c) EXPECT_GE(std::min({v.r, v.g, v.b}), 0) << count;
            EXPECT_TRUE(test::all_finite(c)) << count;
            const Directions directions = test::random_directions(basis->domain(), 500, 4);
            EXPECT_GE(test::least(radiance_of(*basis, c, directions)), 0) << count;
            EXPECT_GE(test::least(irradiance_of(*exact_evaluator(*basis), c, directions)),
                      -1e-6 * test::largest(irradiance_of(*exact_evaluator(*basis), c, directions)))
                << count;
        }
    });
    EXPECT_GE(tested, 10);
}

TEST(EveryCodec, BlackGivesZero) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        for (const std::size_t count : {1, 100, 1000}) {
            const auto c = encode(encoder, test::samples_of(basis->domain(), count, [](Vec3) { return Rgb{}; }));
            for (const Rgb& v : c) EXPECT_EQ(v, Rgb{}) << count;
        }
    });
}

TEST(EveryCodec, NoSamplesGiveZero) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        Accumulator accumulator(encoder);
        accumulator.add(Samples());
        for (const Rgb& v : accumulator.solve()) EXPECT_EQ(v, Rgb{});
        EXPECT_EQ(accumulator.state().size(), encoder->state_size());
        EXPECT_EQ(accumulator.solve().size(), basis->size());
    });
}

TEST(EveryCodec, SamplesOfNoSolidAngleGiveZero) {
    for_each_encoder([](const BasisPtr&, const std::string&, const EncoderPtr& encoder) {
        Samples samples(20);
        for (std::size_t i = 0; i < 20; ++i) samples.set(i, {{0, 0, 1}, {1, 2, 3}, 0});
        for (const Rgb& v : encode(encoder, samples)) EXPECT_EQ(v, Rgb{});
    });
}

TEST(EveryCodec, FewSamplesGiveFiniteCoefficients) {
    for_each_encoder([](const BasisPtr& basis, const std::string&, const EncoderPtr& encoder) {
        const Directions directions = test::random_directions(basis->domain(), 6, 12);
        for (std::size_t i = 0; i < directions.size(); ++i)
            for (const float solid_angle : {1e-6f, 1.0f, 4e3f}) {
                Samples one(1);
                one.set(0, {direction_at(directions, i), {1, 1000, 0}, solid_angle});
                EXPECT_TRUE(test::all_finite(encode(encoder, one))) << i;
                // The same sample over and over: a Gram matrix of rank 1.
                Samples same(40);
                for (std::size_t k = 0; k < 40; ++k) same.set(k, one[0]);
                EXPECT_TRUE(test::all_finite(encode(encoder, same))) << i;
            }
    });
}

// ---- Evaluators ----

TEST(EveryCodec, IrradianceIsLinearWhereItSaysSo) {
    for (const BasisPtr& basis : bases()) {
        const auto c = encode(encoder_of(basis, "least-squares"), sky_samples(basis->domain(), 1024));
        const Directions normals = test::random_directions(Domain::sphere, 300, 8);
        for (const auto& name : basis->evaluator_names()) {
            const auto evaluator = basis->evaluator(name);
            EXPECT_EQ(evaluator->name(), name);
            EXPECT_FALSE(evaluator->accuracy().range.empty());
            if (!evaluator->weights()) continue;
            Colours direct(300), by_weights(300);
            evaluator->signed_irradiance(c, normals, direct);
            evaluate(*evaluator->weights(), c, normals, by_weights);
            const double rounding = 2e-6 * test::largest(direct);
            EXPECT_LE(test::largest_difference(direct, by_weights), rounding) << name;

            std::vector<Rgb> doubled(c);
            for (Rgb& v : doubled) v = v * 2;
            const std::array<std::span<const Rgb>, 2> many = {c, doubled};
            Colours first(300), second(300);
            const std::array<MutableColourView, 2> outputs = {first.view(), second.view()};
            signed_irradiance_many(*evaluator, many, normals, outputs);
            EXPECT_LE(test::largest_difference(first, direct), rounding) << name;
            for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(second.channel(0)[i], 2 * first.channel(0)[i]) << name;
        }
    }
}

TEST(EveryCodec, CodecFaceIsItsThreeParts) {
    for (const char* name : {"sg12/least-squares/hill", "sh3/moments/convolution", "sg12h/nnls/exact"}) {
        const Codec codec = make_codec(name).value();
        const Samples samples = sky_samples(codec.basis().domain(), 500);
        const auto c = codec.encode(samples);
        EXPECT_EQ(c, encode(codec.encoder(), samples));
        const Directions directions = test::random_directions(codec.basis().domain(), 100, 3);
        Colours L(100), E(100), expected = radiance_of(codec.basis(), c, directions);
        codec.radiance(c, directions, L);
        codec.irradiance(c, directions, E);
        if (codec.evaluator().negative() == Negative::clamped) clamp_negative(expected);
        EXPECT_EQ(test::largest_difference(L, expected), 0) << name;
        EXPECT_EQ(test::largest_difference(E, irradiance_of(codec.evaluator(), c, directions)), 0) << name;
    }
}

}  // namespace
}  // namespace lobelia
