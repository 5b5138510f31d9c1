// Tests the closed forms of spherical Gaussians and their Gram matrices against quadrature at every sharpness.
#include "core/math/gaussian.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "core/basis/sg/sg_irradiance.h"
#include "core/basis/sg/spherical_gaussians.h"
#include "lobelia/codec.h"
#include "support.h"

namespace lobelia {
namespace {

using gaussian::Lobe;

constexpr std::array k_sharpness = {0.0, 1e-6, 1e-3, 0.1, 1.0, 6.0, 30.0, 100.0, 1e3, 1e4};

/// Integral over the sphere of exp(sharpness (z - 1)) f(z), in panels that double away from the peak.
template <class F>
double zonal_quadrature(double sharpness, const F& f) {
    static const GaussLegendre rule(24, 0, 1);
    double sum = 0, low = 0;
    for (double step = std::min(2.0, 0.5 / std::max(sharpness, 0.1)); low < 2; step *= 2) {
        const double high = std::min(2.0, low + step);
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double t = low + (high - low) * rule.nodes[i];
            sum += (high - low) * rule.weights[i] * std::exp(-sharpness * t) * f(1 - t);
        }
        low = high;
    }
    return 2 * k_pi * sum;
}

/// The value of a lobe at a direction, in the chord's form.
double value(const Lobe& lobe, Vec3 s) {
    const double x = static_cast<double>(s.x) - lobe.axis.x, y = static_cast<double>(s.y) - lobe.axis.y,
                 z = static_cast<double>(s.z) - lobe.axis.z;
    return std::exp(-0.5 * lobe.sharpness * (x * x + y * y + z * z));
}

Vec3 at_angle(double angle) { return {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))}; }
Lobe lobe_at(double angle, double sharpness) { return {at_angle(angle), static_cast<float>(sharpness)}; }

/// Relative error of the exponent of lobes whose float32 axes are unit vectors only to 6e-8.
double exponent_error(double sharpness) { return 2e-7 * (2 + sharpness); }

TEST(Gaussian, IntegralEqualsQuadrature) {
    for (const double s : k_sharpness) {
        const double expected = zonal_quadrature(s, [](double) { return 1.0; });
        EXPECT_NEAR(gaussian::integral(s), expected, 1e-12 * expected) << s;
    }
    EXPECT_EQ(gaussian::integral(0), 4 * k_pi);
}

TEST(Gaussian, ProductEqualsPointwiseProduct) {
    const Directions axes = test::random_directions(Domain::sphere, 12, 1);
    const Directions directions = test::random_directions(Domain::sphere, 100, 2);
    for (const double s : k_sharpness)
        for (const double t : k_sharpness)
            for (std::size_t k = 0; k + 1 < axes.size(); ++k) {
                // Far apart, and close together.
                const Vec3 far = direction_at(axes, k + 1), axis = direction_at(axes, k);
                for (const Vec3 other : {far, normalize(axis + far * 0.01f)}) {
                    const Lobe a{axis, static_cast<float>(s)}, b{other, static_cast<float>(t)};
                    const auto product = gaussian::product(a, b);
                    ASSERT_TRUE(std::isfinite(product.amplitude) && std::isfinite(product.lobe.sharpness));
                    for (std::size_t j = 0; j < directions.size(); ++j) {
                        const Vec3 d = direction_at(directions, j);
                        const double expected = value(a, d) * value(b, d);
                        ASSERT_NEAR(product.amplitude * value(product.lobe, d), expected,
                                    exponent_error(s + t) * product.amplitude)
                            << s << " " << t;
                    }
                }
            }
}

TEST(Gaussian, ProductOfOppositeLobesIsConstant) {
    const auto product = gaussian::product({{0, 0, 1}, 3}, {{0, 0, -1}, 3});
    EXPECT_EQ(product.lobe.sharpness, 0);
    EXPECT_NEAR(product.amplitude, std::exp(-6.0), 1e-15);
}

TEST(Gaussian, InnerProductEqualsQuadrature) {
    // The sharper lobe points along z, where the panels are narrow. The other is tilted; its integral over azimuths is
    // a Bessel function, which does not overflow at a sharpness of 100.
    for (const double s : k_sharpness)
        for (const double t : {0.0, 1e-6, 1e-3, 0.1, 1.0, 6.0, 30.0, 100.0})
            for (const double angle : {0.0, 0.1, 0.7, 1.5, 2.5, k_pi}) {
                if (s < t) continue;
                const Lobe a = lobe_at(0, s), b = lobe_at(angle, t);
                const double c = b.axis.z, sine = std::sqrt(1 - c * c);
                const double expected = zonal_quadrature(s, [&](double z) {
                    const double x = t * sine * std::sqrt(1 - z * z);
                    return std::exp(t * (z * c - 1)) * std::cyl_bessel_i(0.0, x);
                });
                const double found = gaussian::inner_product(a, b);
                EXPECT_NEAR(found, expected, (1e-9 + exponent_error(std::min(s, t))) * expected)
                    << s << " " << t << " " << angle;
                EXPECT_DOUBLE_EQ(found, gaussian::inner_product(b, a));
            }
}

TEST(Gaussian, InnerProductIsTheIntegralOfTheProduct) {
    for (const double s : k_sharpness)
        for (const double t : k_sharpness)
            for (const double angle : {0.0, 1e-3, 0.3, k_pi}) {
                const Lobe a = lobe_at(0, s), b = lobe_at(angle, t);
                const auto product = gaussian::product(a, b);
                const double expected = product.amplitude * gaussian::integral(product.lobe.sharpness);
                EXPECT_NEAR(gaussian::inner_product(a, b), expected, 1e-6 * expected) << s << " " << t << " " << angle;
                EXPECT_TRUE(std::isfinite(expected));
            }
    // Cases where the naive form overflows float32, and where it would be wrong by a factor of two.
    const Lobe sharp = lobe_at(0, 1e4);
    EXPECT_NEAR(gaussian::inner_product(sharp, sharp), k_pi / 1e4, 1e-9 * k_pi / 1e4);
}

TEST(Gaussian, HemisphereIntegralEqualsQuadrature) {
    const SphereRule rule = product_rule(Domain::hemisphere, 128);
    for (const double s : {0.0, 1e-6, 1e-3, 0.1, 1.0, 6.0, 30.0, 100.0})
        for (const double angle : {0.0, 0.4, 1.2, k_pi / 2, 2.0, 3.0, k_pi}) {
            const Lobe lobe = lobe_at(angle, s);
            double expected = 0;
            for (std::size_t i = 0; i < rule.weights.size(); ++i)
                expected += rule.weights[i] * value(lobe, direction_at(rule.directions, i));
            EXPECT_NEAR(gaussian::hemisphere_integral(s, lobe.axis.z), expected,
                        exponent_error(s) * gaussian::integral(s))
                << s << " at " << angle;
        }
}

TEST(Gaussian, HemisphereIntegralHasItsKnownValues) {
    for (const double s : k_sharpness) {
        const double whole = gaussian::integral(s), tolerance = 1e-12 * whole;
        const double top = s == 0 ? 2 * k_pi : 2 * k_pi * -std::expm1(-s) / s;
        EXPECT_NEAR(gaussian::hemisphere_integral(s, 1), top, tolerance) << s;
        EXPECT_NEAR(gaussian::hemisphere_integral(s, 0), whole / 2, tolerance) << s;
        EXPECT_NEAR(gaussian::hemisphere_integral(s, -1), whole - top, tolerance) << s;
        double previous = 0;
        for (double c = -1; c <= 1; c += 0.01) {
            const double upper = gaussian::hemisphere_integral(s, c), lower = gaussian::hemisphere_integral(s, -c);
            EXPECT_NEAR(upper + lower, whole, tolerance) << s << " at " << c;
            EXPECT_GE(upper, previous - tolerance);
            previous = upper;
        }
    }
}

TEST(Gaussian, HemisphereInnerProductEqualsQuadrature) {
    const SphereRule rule = product_rule(Domain::hemisphere, 128);
    const Directions axes = test::random_directions(Domain::sphere, 8, 3);
    for (const double s : {0.0, 1e-3, 1.0, 6.0, 30.0})
        for (const double t : {1e-6, 0.1, 6.0, 30.0})
            for (std::size_t k = 0; k + 1 < axes.size(); ++k) {
                const Lobe a{direction_at(axes, k), static_cast<float>(s)};
                const Lobe b{direction_at(axes, k + 1), static_cast<float>(t)};
                double expected = 0;
                for (std::size_t i = 0; i < rule.weights.size(); ++i) {
                    const Vec3 d = direction_at(rule.directions, i);
                    expected += rule.weights[i] * value(a, d) * value(b, d);
                }
                EXPECT_NEAR(gaussian::hemisphere_inner_product(a, b), expected,
                            exponent_error(s + t) * gaussian::inner_product(a, b))
                    << s << " " << t;
            }
}

TEST(Gaussian, HemispheresAddUpToTheSphere) {
    const auto mirrored = [](Lobe lobe) {
        lobe.axis.z = -lobe.axis.z;
        return lobe;
    };
    for (const double s : k_sharpness)
        for (const double t : k_sharpness)
            for (const double tilt : {0.2, 1.4, 1.6}) {
                const Lobe a = lobe_at(tilt, s), b = lobe_at(tilt + 0.05, t);
                const double whole = gaussian::inner_product(a, b);
                EXPECT_NEAR(gaussian::hemisphere_inner_product(a, b) +
                                gaussian::hemisphere_inner_product(mirrored(a), mirrored(b)),
                            whole, 1e-11 * whole)
                    << s << " " << t;
            }
}

TEST(Gaussian, ConvolutionKeepsIntegralAndMeanCosine) {
    for (const double s : k_sharpness)
        for (const double t : k_sharpness) {
            const auto result = gaussian::convolution(s, t);
            const double sharpness = result.lobe.sharpness;
            // The result's sharpness is rounded to float32.
            const double integral = gaussian::integral(s) * gaussian::integral(t);
            EXPECT_NEAR(result.amplitude * gaussian::integral(sharpness), integral, 1e-7 * integral) << s << " " << t;
            const double cosine = gaussian::mean_cosine(s) * gaussian::mean_cosine(t);
            EXPECT_NEAR(gaussian::mean_cosine(sharpness), cosine, 1e-7 * cosine + 1e-18) << s << " " << t;
        }
}

TEST(Gaussian, ConvolutionHasTheMomentsOfTheTrueOne) {
    // The true convolution at angle theta is the inner product of one lobe with the other, turned by theta.
    for (const double s : {0.1, 1.0, 6.0, 30.0})
        for (const double t : {1.0, 6.0, 100.0}) {
            const GaussLegendre rule(256);
            double integral = 0, moment = 0;
            for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
                const double z = rule.nodes[i];
                const double f = gaussian::inner_product(lobe_at(0, s), lobe_at(std::acos(z), t));
                integral += 2 * k_pi * rule.weights[i] * f;
                moment += 2 * k_pi * rule.weights[i] * z * f;
            }
            const auto result = gaussian::convolution(s, t);
            const double sharpness = result.lobe.sharpness;
            EXPECT_NEAR(result.amplitude * gaussian::integral(sharpness), integral, 1e-5 * integral) << s << " " << t;
            EXPECT_NEAR(gaussian::mean_cosine(sharpness), moment / integral, 1e-5) << s << " " << t;
        }
}

TEST(Gaussian, MeanCosineEqualsQuadratureAndRoundTrips) {
    for (const double s : {0.0, 1e-6, 1e-3, 0.05, 0.0999, 0.1001, 0.3, 1.0, 6.0, 30.0, 100.0, 1e3, 1e4}) {
        const double expected = zonal_quadrature(s, [](double z) { return z; }) / gaussian::integral(s);
        // Near 0 the quadrature cancels to the rounding of its terms.
        EXPECT_NEAR(gaussian::mean_cosine(s), expected, 1e-11 * expected + 1e-15) << s;
        EXPECT_NEAR(gaussian::sharpness_from_mean_cosine(gaussian::mean_cosine(s)), s, 1e-9 * s) << s;
    }
    EXPECT_EQ(gaussian::sharpness_from_mean_cosine(0), 0);
    for (double r = 0.001; r < 1; r += 0.001)
        EXPECT_NEAR(gaussian::mean_cosine(gaussian::sharpness_from_mean_cosine(r)), r, 1e-12);
}

TEST(GaussianIrradiance, SeriesEqualsOneDimensionalQuadrature) {
    for (const double s : k_sharpness)
        for (double c = -1; c <= 1.0001; c += 0.05) {
            const double cosine = std::min(c, 1.0);
            EXPECT_NEAR(gaussian::irradiance(s, cosine), gaussian::irradiance_by_quadrature(s, cosine),
                        1e-12 * gaussian::integral(s))
                << s << " at " << c;
        }
}

TEST(GaussianIrradiance, EqualsTwoDimensionalQuadrature) {
    const SphereRule rule = product_rule(Domain::hemisphere, 64);
    for (const double s : {0.0, 0.1, 1.0, 6.0, 30.0})
        for (const double angle : {0.0, 0.5, 1.5, 2.0, k_pi}) {
            const Lobe lobe = lobe_at(angle, s);
            double expected = 0;
            for (std::size_t i = 0; i < rule.weights.size(); ++i) {
                const Vec3 d = direction_at(rule.directions, i);
                expected += rule.weights[i] * d.z * value(lobe, d);
            }
            EXPECT_NEAR(gaussian::irradiance(s, lobe.axis.z), expected, 1e-6 * gaussian::integral(s)) << s;
        }
}

TEST(GaussianIrradiance, EndpointsEqualTheirClosedForms) {
    for (const double s : k_sharpness) {
        // s - 1 + e^-s and 1 - e^-s (1 + s), by series where they cancel.
        const double near = s < 0.01 ? 0.5 - s / 6 + s * s / 24 : (s + std::expm1(-s)) / (s * s);
        const double far = s < 0.01 ? 0.5 - s / 3 + s * s / 8 : (1 - std::exp(-s) * (1 + s)) / (s * s);
        const double tolerance = 1e-9 * gaussian::integral(s);
        EXPECT_NEAR(gaussian::irradiance(s, 1), 2 * k_pi * near, tolerance) << s;
        EXPECT_NEAR(gaussian::irradiance(s, -1), 2 * k_pi * std::exp(-s) * far, tolerance) << s;
        if (s > 0 && s <= 100) {
            EXPECT_NEAR(gaussian::irradiance(s, 0), 2 * k_pi * std::exp(-s) * std::cyl_bessel_i(1.0, s) / s,
                        1e-12 * gaussian::integral(s))
                << s;
        }
    }
}

TEST(GaussianIrradiance, OddPartIsExactlyLinear) {
    for (const double s : k_sharpness)
        for (double c = 0; c <= 1; c += 0.125) {
            const double odd = gaussian::irradiance(s, c) - gaussian::irradiance(s, -c);
            EXPECT_NEAR(odd, c * gaussian::integral(s) * gaussian::mean_cosine(s), 1e-14 * gaussian::integral(s))
                << s << " at " << c;
        }
}

TEST(SphericalGaussians, ValuesKeepTheirPrecisionAtEverySharpness) {
    for (const double s : {0.0, 1e-6, 1e-3, 1.0, 100.0, 1e4}) {
        std::vector<Lobe> lobes = vogel_sphere(9);
        for (Lobe& lobe : lobes) lobe.sharpness = static_cast<float>(s);
        const SphericalGaussians basis("test", lobes, Domain::sphere);
        // The axes themselves, their neighbourhoods, and anywhere.
        Directions directions = test::random_directions(Domain::sphere, 200, 4);
        for (std::size_t i = 0; i < 9; ++i) {
            set_entry(directions.view(), i, lobes[i].axis);
            set_entry(directions.view(), 9 + i, normalize(lobes[i].axis + direction_at(directions, 50 + i) * 0.01f));
        }
        std::vector<float> rows(9 * k_block_size);
        basis.values(directions, rows.data());
        for (std::size_t i = 0; i < 9; ++i)
            for (std::size_t j = 0; j < directions.size(); ++j) {
                const double expected = value(lobes[i], direction_at(directions, j));
                // x e^-x <= 1 / e, so that a relative error of the exponent x is that error over e.
                ASSERT_NEAR(rows[i * k_block_size + j], expected, 4e-7) << s;
            }
        for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(rows[i * k_block_size + i], 1) << s;
    }
}

TEST(SphericalGaussians, EveryFloatEvaluationIsFiniteAtExtremeSharpness) {
    std::vector<float> cosines = {-1, -0.99999994f, -1e-20f, 0, 1e-20f, 1e-7f, 0.99999994f, 1};
    for (float c = -1; c <= 1; c += 0.01f) cosines.push_back(c);
    for (const auto& entry : sg_irradiance_list())
        for (const double s : {0.0, 1e-30, 1e-6, 1e-4, 1e-3, 0.01, 0.0315, 0.03151, 0.1, 0.5, 1.0, 2.133, 6.0, 44.0,
                               88.0, 100.0, 1e3, 1e4})
            for (const float e : sg_irradiance(entry.kind, s, cosines))
                EXPECT_TRUE(std::isfinite(e)) << entry.name << " at sharpness " << s;
}

/// Numeric Gram and integrals by quadrature of the float32 values.
void expect_numeric_gram(const LinearBasis& basis, std::size_t heights) {
    const std::size_t n = basis.size();
    const SphereRule rule = product_rule(basis.domain(), heights);
    const Matrix expected = inner_products(basis, basis, rule), gram = basis.gram();
    const auto integrals = basis.integrals();
    std::vector<double> sums(n);
    std::vector<float> rows(n * k_block_size);
    for_each_part(rule.directions.view(), k_block_size, [&](DirectionView block, std::size_t begin) {
        basis.values(block, rows.data());
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < block.size; ++j)
                sums[i] += rule.weights[begin + j] * rows[i * k_block_size + j];
    });
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(integrals[i], sums[i], 1e-6 * sums[i] + 1e-19) << basis.name();
        for (std::size_t j = 0; j < n; ++j) {
            // Lobes well below the horizon count as 0 from e^-46 on.
            EXPECT_NEAR(gram[i * n + j], expected[i * n + j],
                        1e-6 * std::sqrt(gram[i * n + i] * gram[j * n + j]) + 1e-19)
                << basis.name() << " " << i << " " << j;
            EXPECT_EQ(gram[i * n + j], gram[j * n + i]);
        }
    }
}

TEST(SphericalGaussians, GramEqualsNumericGram) {
    for (const char* name : {"sg1", "sg12", "sg12a", "sg24", "sg5h", "sg9h", "sg12h"}) {
        const auto basis = SphericalGaussians::from_name(name);
        ASSERT_TRUE(basis && *basis) << name;
        expect_numeric_gram(*(*basis)->linear(), 64);
    }
    // Lobes of many widths that straddle the horizon.
    std::vector<Lobe> lobes;
    for (const double s : {0.0, 0.1, 3.0, 40.0})
        for (const double angle : {0.0, 1.4, 1.6, 3.0}) lobes.push_back(lobe_at(angle, s));
    expect_numeric_gram(SphericalGaussians("mixed", lobes, Domain::hemisphere), 96);
    expect_numeric_gram(SphericalGaussians("mixed", lobes, Domain::sphere), 96);
}

TEST(SphericalGaussians, HemisphereSetsHaveThePublishedSharpness) {
    // Published as 3.627, 4.260, 5.514 and 6.691; the formula gives 5.51349 for the third.
    const std::array<std::pair<std::size_t, double>, 4> sets = {
        {{5, 3.627195}, {6, 4.259521}, {9, 5.513491}, {12, 6.691397}}};
    for (const auto& [count, sharpness] : sets) {
        const auto lobes = spiral_hemisphere(count);
        ASSERT_EQ(lobes.size(), count);
        for (const Lobe& lobe : lobes) {
            EXPECT_NEAR(lobe.sharpness, sharpness, 2e-6);
            EXPECT_GE(lobe.axis.z, 0);
            EXPECT_NEAR(length(lobe.axis), 1, 2e-7);
        }
    }
}

TEST(SphericalGaussians, VogelSphereHasThePublishedLobes) {
    const auto lobes = vogel_sphere(12);
    const auto expect = [](Vec3 p, Vec3 published) { EXPECT_LT(length(p - published), 1e-6f); };
    expect(lobes[0].axis, {0.399653f, 0, 0.916667f});
    expect(lobes[11].axis, {0.119610f, 0.381334f, -0.916667f});
    for (const std::size_t count : {1, 2, 12, 24, 512})
        for (const Lobe& lobe : vogel_sphere(count)) {
            EXPECT_FLOAT_EQ(lobe.sharpness, static_cast<float>(count) / 2);
            EXPECT_NEAR(length(lobe.axis), 1, 2e-7);
        }
}

TEST(SphericalGaussians, NamesMakeTheirSets) {
    const auto size = [](const char* name) -> std::size_t {
        const auto basis = SphericalGaussians::from_name(name);
        return basis && *basis ? (*basis)->size() : 0;
    };
    EXPECT_EQ(size("sg1"), 1u);
    EXPECT_EQ(size("sg12"), 12u);
    EXPECT_EQ(size("sg12a"), 13u);
    EXPECT_EQ(size("sg9h"), 9u);
    EXPECT_EQ(size("sg512"), 512u);
    for (const char* name : {"", "s", "sg", "sg0", "sg513", "sg-1", "sg12x", "sg12ah", "sg 12", "SG12", "sg12.5", "sh2",
                             "sg99999999999999999999"})
        EXPECT_EQ(size(name), 0u) << name;
}

TEST(Lobes, RoundTrip) {
    const auto lobes = vogel_sphere(7);
    std::string text = "# seven lobes\n\n";
    for (const Lobe& lobe : lobes) {
        char line[128];
        std::snprintf(line, sizeof line, "%.9g %.9g\t%.9g  %.9g # one\r\n", lobe.axis.x, lobe.axis.y, lobe.axis.z,
                      lobe.sharpness);
        text += line;
    }
    const auto read = parse_lobes(text + "  ambient  ", "lobes.txt");
    ASSERT_TRUE(read);
    ASSERT_EQ(read->size(), 8u);
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_LT(length((*read)[i].axis - lobes[i].axis), 2e-7f);
        EXPECT_EQ((*read)[i].sharpness, lobes[i].sharpness);
    }
    EXPECT_EQ(read->back().sharpness, 0);

    // The basis's name holds the lobes: it makes the same basis again.
    for (const auto& [prefix, domain] : {std::pair{"sg{", Domain::sphere}, std::pair{"sgh{", Domain::hemisphere}}) {
        const auto made = spherical_gaussians(*read, domain);
        EXPECT_TRUE(made->name().starts_with(prefix)) << made->name();
        const auto basis = SphericalGaussians::from_name(made->name());
        ASSERT_TRUE(basis && *basis) << made->name();
        EXPECT_EQ((*basis)->name(), made->name());
        EXPECT_EQ((*basis)->domain(), domain);
        EXPECT_EQ(dynamic_cast<const SphericalGaussians&>(**basis).lobes(), *read);
    }
}

TEST(Lobes, AxesAreNormalised) {
    const auto read = parse_lobes("0 0 20 5\n3 0 4 5\n", "lobes.txt");
    ASSERT_TRUE(read);
    EXPECT_EQ((*read)[0].axis, (Vec3{0, 0, 1}));
    EXPECT_LT(length((*read)[1].axis - Vec3{0.6f, 0, 0.8f}), 2e-7f);
}

TEST(Lobes, EveryKindOfBadLineNamesSourceAndLine) {
    for (const char* line :
         {"1 0 0", "1 0 0 5 6", "a b c d", "1,0,0,5", "0 0 0 5", "1e-9 0 0 5", "1e30 0 0 5", "1 0 0 -1", "1 0 0 10001",
          "nan 0 0 5", "inf 0 0 5", "1 0 0 nan", "1 0 0 inf", "1 0 0 5x", "1e999 0 0 5", "ambient 5", "Ambient", "1"}) {
        const auto read = parse_lobes("0 0 1 3\n# comment\n" + std::string(line) + "\n0 0 1 4\n", "lobes.txt");
        ASSERT_FALSE(read) << line;
        EXPECT_NE(read.error().message.find("lobes.txt:3: "), std::string::npos) << read.error().message;
        EXPECT_FALSE(SphericalGaussians::from_name("sg{0 0 1 3;" + std::string(line) + "}"));
    }
}

TEST(Lobes, NoneAndTooManyAreErrors) {
    const auto expect_error = [](const std::string& text) {
        const auto read = parse_lobes(text, "lobes.txt");
        ASSERT_FALSE(read) << text;
        EXPECT_NE(read.error().message.find("lobes.txt"), std::string::npos) << read.error().message;
    };
    expect_error("");
    expect_error("\n# nothing\n\n");
    std::string many;
    for (int i = 0; i < 513; ++i) many += "0 0 1 2\n";
    expect_error(many);
}

TEST(Lobes, NoNameOpensAFile) {
    const std::string path = testing::TempDir() + "lobelia_lobes.txt";
    std::ofstream(path) << "0 0 1 5\n";
    for (const std::string prefix : {"sg:", "sgh:"}) {
        const auto basis = make_basis(prefix + path);
        ASSERT_FALSE(basis);
        EXPECT_NE(basis.error().message.find("command line"), std::string::npos) << basis.error().message;
        EXPECT_FALSE(make_codec(prefix + path + "/moments/exact"));
    }
    for (const char* name : {"sg{", "sg{}", "sgh{;}", "sg{0 0 1 5", "sg{0 0 1 5}x", "sg{0 0 1 5\n0 0 1}"})
        EXPECT_FALSE(make_basis(name)) << name;
    std::remove(path.c_str());
}

}  // namespace
}  // namespace lobelia
