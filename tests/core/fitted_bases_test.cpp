// Tests fitted bases: each fit recovers light that it can represent, and a brute-force search finds nothing better.
#include <gtest/gtest.h>

#include "core/basis/directional_lightmaps.h"
#include "core/basis/sg/fitted_gaussians.h"
#include "core/basis/sh/sh_irradiance.h"
#include "core/math/least_squares.h"
#include "core/math/minimise.h"
#include "ennis.h"
#include "lobelia/codec.h"
#include "measure/comparison.h"
#include "support.h"

namespace lobelia {
namespace {

std::shared_ptr<const Basis> basis_of(const std::string& name) { return make_basis(name).value(); }

std::vector<std::string> fitted_names() {
    std::vector<std::string> names;
    for (const auto& name : basis_names())
        if (basis_of(name)->fitted()) names.push_back(name);
    return names;
}

std::vector<Rgb> encode(const std::string& basis, SampleView samples, const char* encoder = "moments") {
    Accumulator accumulator(make_encoder(encoder, basis_of(basis)).value());
    accumulator.add(samples);
    return accumulator.solve();
}

std::vector<Rgb> fit(const Basis& basis, std::span<const Rgb> accumulated) {
    std::vector<Rgb> c(basis.size());
    basis.fitted()->fit(accumulated, c);
    return c;
}

Colours irradiance_of(const std::string& basis, std::span<const Rgb> c, const Directions& normals) {
    const auto evaluator = basis_of(basis)->evaluator(basis_of(basis)->evaluator_names().back());
    Colours out(normals.size());
    evaluator->signed_irradiance(c, normals, out);
    return out;
}

/// Degree-2 coefficients of a directional light of irradiance `light` across d, and a constant radiance.
std::vector<Rgb> light_and_constant(Vec3 d, Rgb light, Rgb constant) {
    std::vector<Rgb> c;
    for (const double v : harmonics::values(2, d.x, d.y, d.z)) c.push_back(light * static_cast<float>(v));
    c[0] = c[0] + constant * std::sqrt(4 * static_cast<float>(k_pi));
    return c;
}

/// A soft patch of one colour, a gradient of another.
Rgb scene(Vec3 d) {
    const float a = dot(d, normalize(Vec3{1, -1, 2}));
    return {1 + 0.5f * d.x + 6 * std::exp(10 * (a - 1)), 0.8f + 3 * std::exp(10 * (a - 1)), 0.5f + 0.3f * d.z};
}

TEST(EveryFittedBasis, NothingGivesZeros) {
    for (const auto& name : fitted_names()) {
        const auto basis = basis_of(name);
        ASSERT_TRUE(basis->fitted()->accumulated());
        EXPECT_EQ(basis->fitted()->accumulated()->domain(), basis->domain()) << name;
        for (const Rgb& v : fit(*basis, std::vector<Rgb>(basis->fitted()->accumulated()->size())))
            EXPECT_EQ(v, Rgb{}) << name;
    }
}

TEST(EveryFittedBasis, KnowsIntegralsAndProductsOfWhatItAccumulates) {
    const std::size_t n = 200000;
    for (const auto& name : fitted_names()) {
        const auto basis = basis_of(name)->fitted()->accumulated();
        if (basis->size() > 100) continue;  // texels; they have tests of their own
        SCOPED_TRACE(name);
        const Directions directions = uniform_directions(basis->domain(), Sequence::hammersley, n, 0);
        std::vector<double> integrals(basis->size()), products(basis->size() * basis->size());
        std::vector<float> rows(basis->size() * k_block_size);
        for_each_part(directions.view(), k_block_size, [&](DirectionView block, std::size_t) {
            basis->values(block, rows.data());
            for (std::size_t i = 0; i < basis->size(); ++i)
                for (std::size_t j = 0; j < block.size; ++j) {
                    const double v = rows[i * k_block_size + j];
                    integrals[i] += v;
                    for (std::size_t k = 0; k < basis->size(); ++k)
                        products[i * basis->size() + k] += v * rows[k * k_block_size + j];
                }
        });
        const double each = solid_angle(basis->domain()) / static_cast<double>(n);
        for (std::size_t i = 0; i < basis->size(); ++i) EXPECT_NEAR(basis->integrals()[i], integrals[i] * each, 1e-3);
        for (std::size_t i = 0; i < products.size(); ++i) EXPECT_NEAR(basis->gram()[i], products[i] * each, 1e-3);
    }
}

TEST(EveryFittedBasis, KeepsTheStateOfWhatItAccumulates) {
    Samples samples(8), sources(2);
    for (std::size_t i = 0; i < 8; ++i)
        samples.set(i, {normalize(Vec3{1, 2, 1.0f + static_cast<float>(i)}), {1, 2, 3}, 0.3f});
    for (std::size_t i = 0; i < 2; ++i) sources.set(i, {normalize(Vec3{0, 1, 1}), {900, 900, 900}, 1e-4f});
    for (const auto& name : fitted_names())
        for (const auto& encoder_name : encoder_names(*basis_of(name))) {
            SCOPED_TRACE(name + "/" + encoder_name);
            const auto encoder = make_encoder(encoder_name, basis_of(name)).value();
            EXPECT_EQ(encoder->accumulating().basis().name(), basis_of(name)->fitted()->accumulated()->name());
            std::vector<float> state(encoder->state_size()), expected(state.size());
            encoder->add(state, samples);
            encoder->add_sources(state, sources);
            encoder->accumulating().add(expected, samples);
            encoder->accumulating().add_sources(expected, sources);
            EXPECT_EQ(state, expected);
        }
}

TEST(EveryFittedBasis, LightGrowsWithTheLightAndShapeDoesNot) {
    for (const auto& name : fitted_names()) {
        const auto basis = basis_of(name);
        const auto meanings = basis->meanings();
        ASSERT_EQ(meanings.size(), basis->size());
        const Samples samples = test::samples_of(basis->domain(), 4096, scene);
        const Samples brighter = test::samples_of(basis->domain(), 4096, [](Vec3 d) { return scene(d) * 4; });
        const auto a = encode(name, samples), b = encode(name, brighter);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const Rgb expected = meanings[i] == Meaning::light ? a[i] * 4 : a[i];
            EXPECT_LE(test::norm(b[i] - expected), 1e-4 * test::norm(b)) << name << " " << i;
        }
    }
}

// ---- ZH3 ----

TEST(Zh3, OneLightAndAConstantAreExact) {
    // Degree 2 of one light is zonal about it.
    const Vec3 d = normalize(Vec3{2, -1, 0.5f});
    const auto c = light_and_constant(d, {3, 2, 1}, {0.5f, 1, 2});
    const Directions directions = test::random_directions(Domain::sphere, 200, 3);
    Colours expected(200), found(200);
    basis_of("sh2")->radiance(c, directions, expected);
    for (const char* name : {"zh3", "zh3-rgb"}) {
        basis_of(name)->radiance(fit(*basis_of(name), c), directions, found);
        EXPECT_LE(test::largest_difference(found, expected), 2e-6 * test::largest(expected)) << name;
    }
}

/// Squared error of irradiance over all normals.
double irradiance_error(const std::string& basis, std::span<const Rgb> c, std::span<const Rgb> harmonics,
                        const SphereRule& rule) {
    const Colours a = irradiance_of(basis, c, rule.directions);
    const Colours b = irradiance_of("sh2", harmonics, rule.directions);
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < rule.weights.size(); ++i)
            sum += rule.weights[i] * std::pow(static_cast<double>(a.channel(k)[i]) - b.channel(k)[i], 2);
    return sum;
}

std::vector<Rgb> random_light(std::uint32_t seed) {
    std::mt19937 generator(seed);
    const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
    std::vector<Rgb> c = light_and_constant({0, 0, 1}, {}, {1, 1, 1});
    for (int i = 0; i < 3; ++i) {
        const Vec3 d = normalize(Vec3{uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f});
        const auto light = light_and_constant(d, {uniform(), uniform(), uniform()}, {});
        for (std::size_t k = 0; k < c.size(); ++k) c[k] = c[k] + light[k] * 5;
    }
    return c;
}

TEST(Zh3, NoOtherCoefficientsAreBetter) {
    const SphereRule rule = product_rule(Domain::sphere, 8);  // exact for squares of degree 2
    for (const char* name : {"zh3", "zh3-rgb"})
        for (std::uint32_t seed = 0; seed < 6; ++seed) {
            const auto light = random_light(seed);
            const auto best = fit(*basis_of(name), light);
            const double least = irradiance_error(name, best, light, rule);
            std::mt19937 generator(seed);
            for (int trial = 0; trial < 100; ++trial) {
                auto other = best;
                const float size = trial % 2 == 0 ? 0.3f : 0.01f;
                for (std::size_t i = 1; i < 5; ++i)
                    other[i] = other[i] + Rgb{static_cast<float>(generator()) * 0x1p-32f - 0.5f,
                                              static_cast<float>(generator()) * 0x1p-32f - 0.5f,
                                              static_cast<float>(generator()) * 0x1p-32f - 0.5f} *
                                              size;
                EXPECT_GE(irradiance_error(name, other, light, rule), least * (1 - 1e-5)) << name << " " << seed;
            }
        }
}

// ---- Ambient and highlight ----

TEST(AmbientHighlight, FindsALightAndAConstant) {
    const Vec3 d = normalize(Vec3{-1, 2, 0.3f});
    const auto c = fit(*basis_of("ahd"), light_and_constant(d, {3, 2, 0}, {0.5f, 1, 2}));
    EXPECT_LE(test::norm(c[0] - Rgb{0.5f, 1, 2}), 1e-4);
    EXPECT_LE(test::norm(c[1] - Rgb{3, 2, 0}), 1e-4);
    EXPECT_LE(length(Vec3{c[2].r, c[2].g, c[2].b} - d), 5e-4f);
}

TEST(AmbientHighlight, ItsLobeHasTheEnergyOfTheHighlight) {
    const SphereRule rule = product_rule(Domain::sphere, 64);
    Colours radiance(rule.directions.size());
    const std::vector<Rgb> c = {{}, {1, 2, 3}, {0, 0.6f, 0.8f}};
    basis_of("ahd")->radiance(c, rule.directions, radiance);
    double sum = 0;
    for (std::size_t i = 0; i < rule.weights.size(); ++i) sum += rule.weights[i] * radiance.channel(1)[i];
    EXPECT_NEAR(sum, 2, 1e-4);
}

// ---- Directional lightmaps ----

/// Exact irradiance of samples at a normal.
Rgb irradiance_at(SampleView samples, Vec3 n) {
    Directions one(1);
    set_entry(one.view(), 0, n);
    Colours E(1);
    irradiance_sum(samples, one, E);
    return colour_at(E.view(), 0);
}

TEST(DirectionalLightmaps, IrradianceAtTheSurfacesNormalIsExact) {
    const Samples samples = test::samples_of(Domain::hemisphere, 4096, scene);
    Directions up(1);
    set_entry(up.view(), 0, Vec3{0, 0, 1});
    const Rgb expected = irradiance_at(samples, {0, 0, 1});
    for (const char* name : {"irradz", "enlighten", "enlighten-rgb"})
        for (const char* encoder : {"moments", "least-squares"}) {
            const Colours E = irradiance_of(name, encode(name, samples, encoder), up);
            // Moments over the samples replace moments over the domain: the error is that of the sequence.
            EXPECT_LE(test::norm(colour_at(E.view(), 0) - expected), 1e-3 * test::norm(expected)) << name << encoder;
        }
}

TEST(DirectionalLightmaps, IrradzIsTheNearestToTheTruth) {
    // Its error over the upper normals does not fall in any direction that keeps E(z).
    const Samples samples = test::samples_of(Domain::hemisphere, 4096, scene);
    const SphereRule rule = product_rule(Domain::hemisphere, 12);
    Colours truth(rule.directions.size());
    irradiance_sum(samples, rule.directions, truth);
    const auto error = [&](const std::vector<Rgb>& c) {
        const Colours E = irradiance_of("irradz", c, rule.directions);
        double sum = 0;
        for (std::size_t i = 0; i < rule.weights.size(); ++i)
            sum += rule.weights[i] * std::pow(E.channel(0)[i] - truth.channel(0)[i], 2);
        return sum;
    };
    const auto best = encode("irradz", samples);
    const double least = error(best);
    // E(z) = sqrt(pi) / 2 c_0 + sqrt(pi / 3) c_2.
    const float along_z = std::sqrt(3.0f) / 2;
    for (const Vec3 move :
         {Vec3{0.05f, 0, 0}, {-0.05f, 0, 0}, {0, 0.05f, 0}, {0, -0.05f, 0}, {0, 0, 0.05f}, {0, 0, -0.05f}}) {
        auto other = best;
        other[3].r += move.x;
        other[1].r += move.y;
        other[0].r += move.z;
        other[2].r -= move.z * along_z;
        EXPECT_GT(error(other), least * 0.9999);
    }
}

TEST(DirectionalLightmaps, AConstantSkyIsExactAtEveryNormalAboveTheHorizon) {
    // Half of the sphere bright: E = pi (1 + n_z) / 2.
    const Samples samples = test::samples_of(Domain::hemisphere, 16384, [](Vec3) { return Rgb{1, 2, 3}; });
    const Directions normals = test::random_directions(Domain::hemisphere, 50, 5);
    for (const char* name : {"sh1h", "irradz", "enlighten", "enlighten-rgb"}) {
        const Colours E = irradiance_of(name, encode(name, samples), normals);
        for (std::size_t i = 0; i < 50; ++i)
            EXPECT_NEAR(E.channel(1)[i], k_pi * (1 + normals.channel(2)[i]), 2e-3) << name;
    }
}

TEST(DirectionalLightmaps, Sh1hIsTheSumOfItsSamples) {
    // E = integral of L / 4 + (integral of L w) . n / 2.
    const Samples samples = test::samples_of(Domain::hemisphere, 8192, scene);
    double sum = 0;
    std::array<double, 3> first{};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const RadianceSample s = samples[i];
        sum += s.solid_angle * s.radiance.r;
        first[0] += s.solid_angle * s.radiance.r * s.direction.x;
        first[1] += s.solid_angle * s.radiance.r * s.direction.y;
        first[2] += s.solid_angle * s.radiance.r * s.direction.z;
    }
    const Directions normals = test::random_directions(Domain::sphere, 20, 5);
    const Colours E = irradiance_of("sh1h", encode("sh1h", samples), normals);
    for (std::size_t i = 0; i < 20; ++i) {
        const Vec3 n = direction_at(normals.view(), i);
        EXPECT_NEAR(E.channel(0)[i], sum / 4 + (first[0] * n.x + first[1] * n.y + first[2] * n.z) / 2, 2e-3);
    }
}

TEST(DirectionalLightmaps, DirectionsAreNoLongerThanOne) {
    const auto light = [](Vec3 d) { return Rgb{1, 1, 1} * std::exp(60 * (dot(d, normalize(Vec3{2, 0, 1})) - 1)); };
    const auto c = encode("enlighten", test::samples_of(Domain::hemisphere, 4096, light));
    EXPECT_LE(length(Vec3{c[1].r, c[1].g, c[1].b}), 1.00001f);
    EXPECT_GE(test::least(irradiance_of("enlighten", c, test::random_directions(Domain::sphere, 100, 1))), -1e-5);
}

// ---- The ambient cube of irradiances ----

TEST(AmbientCubeIrradiance, IsTheBestFitToTheIrradiance) {
    const Samples samples = test::samples_of(Domain::sphere, 8192, scene);
    const auto c = encode("ambient-cube-e", samples);
    // Solve by QR on the exact irradiance at many normals.
    const SphereRule rule = product_rule(Domain::sphere, 24);
    Colours E(rule.directions.size());
    irradiance_sum(samples, rule.directions, E);
    Samples irradiance(E.size());
    for (std::size_t i = 0; i < E.size(); ++i)
        irradiance.set(
            i, {direction_at(rule.directions.view(), i), colour_at(E.view(), i), static_cast<float>(rule.weights[i])});
    const auto expected = least_squares_by_qr(*basis_of("ambient-cube")->linear(), irradiance);
    EXPECT_LE(test::distance(c, expected), 2e-3 * test::norm(expected));
}

// ---- Fitted lobes ----

TEST(FittedGaussians, FindLobesThatAreThere) {
    const auto light = [](Vec3 d) {
        const auto lobe = [&](Vec3 p, float s) { return std::exp(s * (dot(d, normalize(p)) - 1)); };
        return Rgb{4, 1, 0} * lobe({1, 2, 3}, 12) + Rgb{0.5f, 2, 1} * lobe({-1, 0.2f, 0.1f}, 5) +
               Rgb{0.1f, 0.1f, 0.8f} * lobe({0, 0, -1}, 1);
    };
    const auto c = encode("sgfit3", test::samples_of(Domain::sphere, 65536, light));
    const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
    const Directions directions = test::random_directions(Domain::sphere, 1000, 3);
    Colours found(1000);
    basis_of("sgfit3")->radiance(c, directions, found);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        const Rgb expected = light(direction_at(directions.view(), i));
        error += std::pow(test::norm(colour_at(found.view(), i) - expected), 2);
        size += std::pow(test::norm(expected), 2);
    }
    EXPECT_LT(std::sqrt(error / size), 0.02);
    for (const float sharpness : {12.0f, 5.0f, 1.0f}) {
        float nearest = 1e9f;
        for (const auto& lobe : lobes) nearest = std::min(nearest, std::abs(std::log(lobe.sharpness / sharpness)));
        EXPECT_LT(nearest, 0.1f) << sharpness;
    }
}

TEST(FittedGaussians, AreNeverNegativeAndInOrderOfTheirLight) {
    const auto c = encode("sgfit4", test::samples_of(Domain::sphere, 4096, scene));
    const auto [lobes, amplitudes] = FittedGaussians::lobes(c);
    double last = HUGE_VAL;
    for (std::size_t j = 0; j < lobes.size(); ++j) {
        EXPECT_GE(std::min({amplitudes[j].r, amplitudes[j].g, amplitudes[j].b}), 0);
        const double light = luminance(amplitudes[j]) * gaussian::integral(lobes[j].sharpness);
        EXPECT_LE(light, last * 1.0001);
        last = light;
    }
}

TEST(FittedGaussians, SixLobesOnEnnisAreFarBelowTwelveFixedOnes) {
    SKIP_WITHOUT_ENNIS();
    ComparisonOptions options;
    options.pictures = options.convergence = false;
    const auto result =
        compare(test::ennis(), {{"sgfit6", "moments", "exact"}, {"sg12", "least-squares", "exact"}}, options).value();
    EXPECT_EQ(result.methods[0].c.size(), result.methods[1].c.size());
    EXPECT_LT(result.methods[0].radiance.rms, 3.0);
    EXPECT_GT(result.methods[1].radiance.rms, 4.5);
}

// ---- Known figures on ennis.hdr ----

TEST(Ennis, IrradianceErrorsAreTheKnownOnes) {
    SKIP_WITHOUT_ENNIS();
    ComparisonOptions options;
    options.pictures = options.convergence = false;
    struct Known {
        const char* codec;
        double relative;  ///< RMS of E / pi by solid angle over the mean radiance
    };
    const std::vector<Known> known = {
        {"sh1/projection/convolution", .385},      {"sh1/projection/geomerics", .142},
        {"sh1/projection/zh3-hallucinated", .118}, {"zh3/moments/convolution", .079},
        {"ambient-cube-e/moments/squares", .321},  {"dice-srbf/least-squares/exact", .085},
        {"sg12/least-squares/exact", .158},        {"sg12/joint/exact", .087}};
    std::vector<CodecName> names;
    for (const Known& k : known) names.push_back(parse_codec_name(k.codec).value());
    const auto result = compare(test::ennis(), names, options).value();
    const double mean = (result.mean_radiance.r + result.mean_radiance.g + result.mean_radiance.b) / 3;
    for (std::size_t i = 0; i < known.size(); ++i)
        EXPECT_NEAR(result.methods[i].irradiance_over_pi.rms / mean, known[i].relative, 0.03 * known[i].relative)
            << known[i].codec;
}

// ---- The minimiser ----

TEST(Minimise, FindsTheBottomOfAQuadraticAndOfRosenbrocksValley) {
    const Objective quadratic = [](std::span<const double> x, std::span<double> gradient) {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double scale = static_cast<double>(1 + i * i), d = x[i] - static_cast<double>(i);
            sum += scale * d * d;
            gradient[i] = 2 * scale * d;
        }
        return sum + 1;
    };
    std::vector<double> x(8, 5.0);
    EXPECT_NEAR(minimise(quadratic, x, {.most_steps = 200, .least_change = 1e-15}), 1, 1e-9);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(x[i], static_cast<double>(i), 1e-4);

    const Objective valley = [](std::span<const double> p, std::span<double> gradient) {
        const double a = 1 - p[0], b = p[1] - p[0] * p[0];
        gradient[0] = -2 * a - 400 * p[0] * b;
        gradient[1] = 200 * b;
        return a * a + 100 * b * b;
    };
    std::vector<double> p = {-1.2, 1};
    EXPECT_LT(minimise(valley, p, {.most_steps = 300, .least_change = 1e-14}), 1e-8);
    EXPECT_NEAR(p[0], 1, 1e-3);
}

TEST(Minimise, NeverRises) {
    // A kink, where the gradient is misleading.
    const Objective corner = [](std::span<const double> x, std::span<double> gradient) {
        gradient[0] = x[0] > 0 ? 1 : -3;
        return x[0] > 0 ? x[0] : -3 * x[0];
    };
    std::vector<double> x = {2};
    EXPECT_LE(minimise(corner, x), 2);
}

}  // namespace
}  // namespace lobelia
