// Tests the irradiance evaluators of spherical harmonics: invariants of the models, guarantees of the windows.
#include "core/basis/sh/sh_irradiance.h"

#include <gtest/gtest.h>

#include "lobelia/codec.h"
#include "support.h"

namespace lobelia {
namespace {

/// Coefficients of degree `degree` of a directional light from `d` of irradiance 1 across it, and of a constant.
std::vector<Rgb> light_and_constant(std::size_t degree, Vec3 d, float light, float constant) {
    const auto y = harmonics::values(degree, d.x, d.y, d.z);
    std::vector<Rgb> c;
    for (const double v : y) c.push_back(Rgb{1, 0.5f, 0.25f} * (light * static_cast<float>(v)));
    c[0] = c[0] + Rgb{1, 1, 1} * (constant * std::sqrt(4 * static_cast<float>(k_pi)));
    return c;
}

Colours read(const char* evaluator, std::size_t degree, std::span<const Rgb> c, const Directions& normals) {
    Colours E(normals.size());
    irradiance(*sh_evaluator(evaluator, degree), c, normals, E);
    return E;
}

Rgb mean(const Colours& values, const SphereRule& rule) {
    double sums[3] = {};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < values.size(); ++i) sums[k] += rule.weights[i] * values.channel(k)[i] / (4 * k_pi);
    return {static_cast<float>(sums[0]), static_cast<float>(sums[1]), static_cast<float>(sums[2])};
}

TEST(ShModels, AConstantEnvironmentIsExactlyItsRadiance) {
    const Directions normals = test::random_directions(Domain::sphere, 200, 1);
    for (std::size_t degree = 1; degree <= 4; ++degree)
        for (const auto& name : sh_evaluator_names(degree)) {
            const auto E = read(name.c_str(), degree, light_and_constant(degree, {0, 0, 1}, 0, 3), normals);
            for (std::size_t i = 0; i < normals.size(); ++i)
                EXPECT_NEAR(E.channel(0)[i] / k_pi, 3, 3e-6 * 3) << name << " of degree " << degree;
        }
}

TEST(Geomerics, KeepsTheMeanAndIsNeverNegative) {
    // The mean of q^p over all normals is 1 / (p + 1).
    const SphereRule rule = product_rule(Domain::sphere, 48);
    for (const float constant : {0.0f, 0.1f, 1.0f}) {
        const auto c = light_and_constant(1, normalize(Vec3{1, -2, 0.5f}), 2, constant);
        const Colours model = read("geomerics", 1, c, rule.directions);
        const Rgb a = mean(model, rule), b = mean(read("convolution-signed", 1, c, rule.directions), rule);
        EXPECT_LE(test::norm(a - b), 1e-4 * test::norm(b)) << constant;
        EXPECT_GE(test::least(model), 0);
    }
}

TEST(Geomerics, ADirectionalLightIsDarkBehind) {
    const auto c = light_and_constant(1, {0, 0, 1}, 1, 0);
    Directions normals(2);
    set_entry(normals.view(), 0, Vec3{0, 0, 1});
    set_entry(normals.view(), 1, Vec3{0, 0, -1});
    const Colours E = read("geomerics", 1, c, normals);
    EXPECT_NEAR(E.channel(0)[0], 1, 1e-5);  // R0 = 1 / 4 pi, a = 0, p = 3: E = pi R0 4 q^3
    EXPECT_NEAR(E.channel(0)[1], 0, 1e-5);
}

TEST(Zh3Hallucinated, AddsTheZonalBandOfItsFormula) {
    const Vec3 d = normalize(Vec3{1, 2, 3});
    const auto c = light_and_constant(1, d, 1, 0.05f);
    const Directions normals = test::random_directions(Domain::sphere, 100, 1);
    const Colours model = read("zh3-hallucinated", 1, c, normals);
    const Colours linear = read("convolution-signed", 1, c, normals);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const double t = dot(d, direction_at(normals, i));
        const double l1 = std::hypot(c[1].g, c[2].g, c[3].g), ratio = l1 / c[0].g;
        const double z = c[0].g * (0.08 * ratio + 0.6 * ratio * ratio);
        const double expected = linear.channel(1)[i] + k_pi / 4 * z * std::sqrt(5 / (16 * k_pi)) * (3 * t * t - 1);
        EXPECT_NEAR(model.channel(1)[i], std::max(0.0, expected), 1e-5);
    }
}

TEST(Windows, AreOneAtTheMeanAndFall) {
    for (std::size_t degree = 1; degree <= 8; ++degree)
        for (const auto& window :
             {hann_window(degree), lanczos_window(degree), laplacian_window(degree), dering_window(degree, 12)}) {
            ASSERT_EQ(window.size(), degree + 1);
            EXPECT_EQ(window[0], 1);
            for (std::size_t l = 1; l <= degree; ++l) EXPECT_LT(window[l], window[l - 1]);
            EXPECT_GT(window[degree], 0);
        }
    EXPECT_NEAR(hann_window(2)[1], 0.75, 1e-12);
    EXPECT_NEAR(lanczos_window(1)[1], 2 / k_pi, 1e-12);
    EXPECT_NEAR(laplacian_window(3)[3], 0.5, 1e-12);
}

/// Minimum over a dense set of directions, the slow and obvious form.
double least_by_brute_force(std::size_t degree, std::span<const Rgb> c) {
    const SphereRule rule = product_rule(Domain::sphere, 128);
    Colours values(rule.directions.size());
    harmonics::Harmonics(degree).sum(c, rule.directions, values);
    return test::least(values);
}

TEST(LeastValue, EqualsBruteForce) {
    for (std::size_t degree = 1; degree <= 6; ++degree)
        for (std::uint32_t seed = 0; seed < 10; ++seed) {
            const auto c = test::random_colours(harmonics::coefficient_count(degree), seed);
            const double found = least_value(degree, c), expected = least_by_brute_force(degree, c);
            // The dense set misses the minimum by its spacing.
            EXPECT_LE(found, expected + 1e-5) << degree << " " << seed;
            EXPECT_GE(found, expected - 0.01 * test::norm(c)) << degree << " " << seed;
        }
}

TEST(Dering, IrradianceIsNowhereNegativeAndDampedNoMoreThanThat) {
    for (std::size_t degree = 1; degree <= 4; ++degree) {
        const Vec3 d = normalize(Vec3{-1, 0.2f, 0.7f});
        const auto c = light_and_constant(degree, d, 1, 0.01f);
        const double w = sufficient_window(degree, c);
        const auto least = [&](double window) {
            const auto factors = dering_window(degree, window);
            std::vector<Rgb> damped(c);
            for (std::size_t l = 0; l <= degree; ++l)
                for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
                    damped[i] = damped[i] * static_cast<float>(factors[l] * harmonics::clamped_cosine(l));
            return least_by_brute_force(degree, damped);
        };
        EXPECT_GE(least(w), -1e-5) << degree;
        if (std::isfinite(w)) {
            EXPECT_LT(least(1.02 * w), 1e-6) << degree;
        }
    }
}

TEST(Dering, AnyLightsAreLiftedToZeroByTheLeastWindow) {
    const SphereRule rule = product_rule(Domain::sphere, 64);
    for (std::size_t degree = 1; degree <= 4; ++degree)
        for (std::uint32_t seed = 0; seed < 8; ++seed) {
            // Three lights of random colours, and a little of every coefficient.
            std::mt19937 generator(seed);
            const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
            auto c = light_and_constant(degree, {0, 0, 1}, 0, 0.02f);
            for (int light = 0; light < 3; ++light) {
                const Vec3 d = normalize(Vec3{uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f});
                const auto one = light_and_constant(degree, d, 1, 0);
                const Rgb colour{uniform(), uniform(), uniform()};
                for (std::size_t i = 0; i < c.size(); ++i)
                    c[i] = c[i] + Rgb{one[i].r * colour.r, one[i].g * colour.g, one[i].b * colour.b};
            }
            const auto lowest = [&](double window) {
                Colours E(rule.directions.size());
                const auto factors = dering_window(degree, window);
                auto damped = c;
                for (std::size_t l = 0; l <= degree; ++l)
                    for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i)
                        damped[i] = damped[i] * static_cast<float>(factors[l] * harmonics::clamped_cosine(l));
                harmonics::Harmonics(degree).sum(damped, rule.directions, E);
                return std::min<double>(test::least(E), least_value(degree, damped));
            };
            const double w = sufficient_window(degree, c);
            EXPECT_GE(lowest(w), -1e-5) << degree << " " << seed;
            if (std::isfinite(w)) {
                EXPECT_LT(lowest(1.002 * w), 1e-6) << degree << " " << seed;
            }
            // The evaluator's own E, before it is clamped.
            Colours E(rule.directions.size());
            sh_evaluator("dering", degree)->signed_irradiance(c, rule.directions, E);
            EXPECT_GE(test::least(E), -1e-5) << degree << " " << seed;
        }
}

TEST(Dering, LeavesAloneWhatDoesNotRing) {
    for (std::size_t degree = 1; degree <= 4; ++degree) {
        const auto c = light_and_constant(degree, {0, 0, 1}, 0.1f, 1);
        EXPECT_TRUE(std::isinf(sufficient_window(degree, c)));
        const Directions normals = test::random_directions(Domain::sphere, 100, 1);
        EXPECT_EQ(test::largest_difference(read("dering", degree, c, normals), read("convolution", degree, c, normals)),
                  0);
    }
}

TEST(ShModels, BlackAndLightlessAreFinite) {
    const Directions normals = test::random_directions(Domain::sphere, 50, 1);
    for (const auto& name : sh_evaluator_names(1)) {
        EXPECT_EQ(test::largest(read(name.c_str(), 1, std::vector<Rgb>(4), normals)), 0) << name;
        // A mean of 0 or less with a gradient is not a valid radiance, but noise can produce it.
        std::vector<Rgb> c(4);
        c[2] = {1, -1, 2};
        EXPECT_TRUE(test::all_finite(read(name.c_str(), 1, c, normals))) << name;
        c[0] = {-1, 1e-30f, 0};
        EXPECT_TRUE(test::all_finite(read(name.c_str(), 1, c, normals))) << name;
    }
}

TEST(HarmonicSums, EqualTheirTables) {
    for (std::size_t degree = 0; degree <= 8; ++degree) {
        const harmonics::Harmonics set(degree);
        const auto c = test::random_colours(harmonics::coefficient_count(degree), 5);
        for (const std::size_t size : {1, 15, 16, 17, 300}) {
            const Directions directions = test::random_directions(Domain::sphere, size, 2);
            Colours sum(size), table(size);
            set.sum(c, directions, sum);
            evaluate(set, c, directions, table);
            EXPECT_LE(test::largest_difference(sum, table), 1e-5) << degree << " " << size;
        }
    }
}

}  // namespace
}  // namespace lobelia
