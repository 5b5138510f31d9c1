// Tests every irradiance evaluator against the error that it states within its range; exact evaluators are exact.
#include <gtest/gtest.h>

#include <map>

#include "core/basis/sg/sg_irradiance.h"
#include "core/basis/sg/spherical_gaussians.h"
#include "core/basis/sh/spherical_harmonics.h"
#include "core/math/gaussian.h"
#include "support.h"

namespace lobelia {
namespace {

std::vector<float> cosines() {
    std::vector<float> result;
    for (int i = -200; i <= 200; ++i) result.push_back(static_cast<float>(i) / 200);
    return result;
}

struct Deviation {
    double largest = 0, rms = 0;
};

/// Error of `kind` over the integral of the lobe, in float32: cosines are spread evenly over a sphere of normals.
Deviation deviation(SgIrradiance kind, double sharpness) {
    const auto c = cosines();
    const auto found = sg_irradiance(kind, sharpness, c);
    const auto series = gaussian::irradiance_series(sharpness);
    Deviation result;
    double squares = 0, total = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const double error = (found[i] - gaussian::zonal_sum(series, c[i])) / gaussian::integral(sharpness);
        result.largest = std::abs(error) <= result.largest ? result.largest : std::abs(error);  // NaN stays
        const double weight = i == 0 || i + 1 == c.size() ? 0.5 : 1;
        squares += weight * error * error;
        total += weight;
    }
    result.rms = std::sqrt(squares / total);
    return result;
}

TEST(SgIrradiance, StaysWithinTheStatedErrorOverTheStatedRange) {
    for (const auto& entry : sg_irradiance_list()) {
        int tested = 0;
        std::vector<double> sharpness = {entry.low, entry.high};
        for (int i = 0; i <= 80; ++i) sharpness.push_back(std::pow(10.0, -1 + 4.0 * i / 80));
        for (const double s : sharpness) {
            if (s < entry.low || s > entry.high) continue;
            ++tested;
            EXPECT_LE(deviation(entry.kind, s).largest, entry.error) << entry.name << " at sharpness " << s;
        }
        EXPECT_GE(tested, 30) << entry.name;
    }
}

TEST(SgIrradiance, StatedErrorsAreNotIdle) {
    for (const auto& entry : sg_irradiance_list()) {
        if (entry.kind == SgIrradiance::exact) continue;  // it states the rounding of float32
        double largest = 0;
        for (int i = 0; i <= 80; ++i) {
            const double s = std::pow(10.0, -1 + 4.0 * i / 80);
            if (s >= entry.low && s <= entry.high) largest = std::max(largest, deviation(entry.kind, s).largest);
        }
        EXPECT_GT(largest, 0.75 * entry.error) << entry.name << " could state less";
    }
}

/// The error table of the reference: max |error| / I, and its RMS over the sphere where printed. Two entries are
/// rounded here as their exact values are: inner product at 4, .03045 (printed 3.1e-2), and punctual at 1, where
/// 1 - E(1) / I = .57454 (printed .58).
struct Row {
    SgIrradiance kind;
    std::array<const char*, 8> largest;
    std::array<const char*, 8> rms;
};
constexpr std::array<double, 8> k_table_sharpness = {0.5, 1, 2, 4, 8, 16, 32, 64};
const std::vector<Row> k_table = {
    {SgIrradiance::inner_product,
     {"2.7e-2", "3.2e-2", "3.7e-2", "4.6e-2", "6.0e-2", "9.5e-2", ".128", ".148"},
     {"2.1e-2", "2.2e-2", "2.5e-2", "3.0e-2", "3.9e-2", "5.0e-2", "5.9e-2", "6.5e-2"}},
    {SgIrradiance::punctual,
     {".66", ".57", ".42", ".25", ".13", "9.7e-2", "7.0e-2", "5.0e-2"},
     {".28", ".24", ".18", ".11", "6.5e-2", "3.7e-2", "2.1e-2", "1.2e-2"}},
    {SgIrradiance::hill,
     {".53", "4.1e-2", "9.3e-3", "6.1e-3", "1.5e-2", "1.6e-2", "1.3e-2", "9.8e-3"},
     {".32", "3.0e-2", "3.4e-3", "3.9e-3", "7.1e-3", "6.2e-3", "4.3e-3", "2.8e-3"}},
    {SgIrradiance::meder, {"1.7e-3", "8.6e-4", "4.5e-3", "7.9e-3", "1.1e-2", "1.1e-2", "9.5e-3", "8.7e-3"}, {}},
    {SgIrradiance::tokuyoshi,
     {"3.0e-6", "3.6e-5", "2.1e-4", "9.8e-4", "1.1e-3", "4.7e-4", "1.6e-4", "6.4e-5"},
     {"1.7e-6", "2.5e-5", "1.5e-4", "6.6e-4", "7.3e-4", "2.7e-4", "7.9e-5", "2.5e-5"}},
    {SgIrradiance::odd_exact, {"5e-7", "7e-6", "4.3e-5", "3.1e-4", "3.8e-4", "1.3e-4", "3.1e-5", "2.3e-5"}, {}},
    {SgIrradiance::odd_exact_2, {"1.1e-5", "4.3e-5", "1.3e-5", "3.1e-5", "4.6e-5", "4.5e-5", "4.5e-5", "3.4e-5"}, {}},
};

/// Half a unit of the last digit printed.
double half_unit(const std::string& printed) {
    const auto point = printed.find('.'), exponent = printed.find('e');
    const auto end = exponent == std::string::npos ? printed.size() : exponent;
    const int digits = point == std::string::npos ? 0 : static_cast<int>(end - point - 1);
    const int power = exponent == std::string::npos ? 0 : std::stoi(printed.substr(exponent + 1));
    return 0.5 * std::pow(10.0, power - digits);
}

/// The float32 rounding of E / I that comes on top of what was printed from double precision.
constexpr double k_rounding = 1e-7;

TEST(SgIrradiance, ErrorTableIsThePrintedOne) {
    for (const Row& row : k_table)
        for (std::size_t i = 0; i < k_table_sharpness.size(); ++i) {
            const bool ours = row.kind == SgIrradiance::odd_exact || row.kind == SgIrradiance::odd_exact_2;
            const Deviation found = deviation(row.kind, k_table_sharpness[i]);
            const auto name = sg_irradiance_list()[static_cast<std::size_t>(row.kind)].name;
            const double printed = std::stod(row.largest[i]), half = half_unit(row.largest[i]);
            EXPECT_LE(found.largest, printed + half + k_rounding) << name << " at " << k_table_sharpness[i];
            if (!ours) {
                EXPECT_GE(found.largest, printed - half - k_rounding) << name << " at " << k_table_sharpness[i];
            }
            if (row.rms[i]) {
                EXPECT_NEAR(found.rms, std::stod(row.rms[i]), half_unit(row.rms[i]) + k_rounding)
                    << name << " (rms) at " << k_table_sharpness[i];
            }
        }
}

TEST(SgIrradiance, FixedSharpnessPolynomialsAreThePrintedOnes) {
    struct PolynomialRow {
        double sharpness, half_mean_cosine;
        std::array<double, 4> q;
        std::array<const char*, 3> errors;  ///< of degree 2, 3, 4 in c^2
    };
    const std::vector<PolynomialRow> rows = {
        {4, .37533558, {.17881624, .23515420, -.03984754, .00537907}, {"1.7e-4", "5.4e-6", "1e-7"}},
        {6, .41667281, {.15209823, .34637927, -.10389592, .02254302}, {"7.1e-4", "4.6e-5", "2.3e-6"}},
        {8, .43750011, {.13430079, .43407752, -.18073533, .05005718}, {"1.6e-3", "1.6e-4", "1.3e-5"}}};
    for (const auto& row : rows) {
        EXPECT_NEAR(gaussian::mean_cosine(row.sharpness) / 2, row.half_mean_cosine, 5.1e-9);
        const auto q = fit_even_part(row.sharpness, 4);
        // Both are minimax: the polynomials, not each coefficient, are determined to the error's own digits.
        for (double x = 0; x <= 1; x += 0.01) {
            const double printed = row.q[0] + x * (row.q[1] + x * (row.q[2] + x * row.q[3]));
            const double found = q[0] + x * (q[1] + x * (q[2] + x * q[3]));
            EXPECT_NEAR(found, printed, 0.05 * std::stod(row.errors[1])) << row.sharpness << " at " << x;
        }

        const auto series = gaussian::irradiance_series(row.sharpness);
        for (std::size_t degree = 2; degree <= 4; ++degree) {
            const auto fit = fit_even_part(row.sharpness, degree + 1);
            double largest = 0;
            for (double c = 0; c <= 1; c += 0.001) {
                double even = 0;
                for (std::size_t j = fit.size(); j-- > 0;) even = even * c * c + fit[j];
                const double expected = gaussian::zonal_sum(series, c) / gaussian::integral(row.sharpness);
                largest = std::max(largest, std::abs(gaussian::mean_cosine(row.sharpness) * c / 2 + even - expected));
            }
            const std::string printed = row.errors[degree - 2];
            EXPECT_LE(largest, std::stod(printed) + half_unit(printed)) << row.sharpness << " degree " << degree;
        }
    }
}

TEST(SgIrradiance, AmbientLobeGivesPi) {
    for (const auto& entry : sg_irradiance_list())
        for (const float e : sg_irradiance(entry.kind, 0, cosines()))
            ASSERT_EQ(e, static_cast<float>(k_pi)) << entry.name;
}

TEST(SgIrradiance, NamesRoundTripAndAccuracyIsStated) {
    for (const auto& entry : sg_irradiance_list()) {
        EXPECT_EQ(sg_irradiance_from_name(entry.name), entry.kind);
        const SgIrradianceWeights weights(entry.kind, vogel_sphere(3));
        EXPECT_EQ(weights.name(), entry.name);
        EXPECT_FALSE(weights.accuracy().range.empty());
        EXPECT_FALSE(weights.accuracy().error.empty());
    }
    EXPECT_FALSE(sg_irradiance_from_name("hil"));
}

/// Irradiance of each basis function at `n`, by a rule over the hemisphere about n.
std::vector<double> numeric_irradiance(const FunctionSet& basis, Vec3 n, const SphereRule& rule) {
    std::vector<double> result(basis.size());
    std::vector<float> rows(basis.size() * k_block_size);
    const Directions directions = test::turned(rule.directions, test::rotation_to(n));
    for_each_part(directions.view(), k_block_size, [&](DirectionView block, std::size_t begin) {
        basis.values(block, rows.data());
        for (std::size_t i = 0; i < basis.size(); ++i)
            for (std::size_t j = 0; j < block.size; ++j)
                result[i] +=
                    rule.weights[begin + j] * rule.directions.channel(2)[begin + j] * rows[i * k_block_size + j];
    });
    return result;
}

void expect_exact(const LinearBasis& basis, const std::string& evaluator_name) {
    const SphereRule rule = product_rule(Domain::hemisphere, 32);
    const Directions normals = test::random_directions(Domain::sphere, 40, 6);
    const auto evaluator = basis.evaluator(evaluator_name);
    ASSERT_TRUE(evaluator && evaluator->weights());
    std::vector<float> rows(basis.size() * k_block_size);
    evaluator->weights()->values(normals, rows.data());
    for (std::size_t j = 0; j < normals.size(); ++j) {
        const auto expected = numeric_irradiance(basis, direction_at(normals, j), rule);
        for (std::size_t i = 0; i < basis.size(); ++i)
            EXPECT_NEAR(rows[i * k_block_size + j], expected[i], 3e-6) << basis.name() << " function " << i;
    }
}

TEST(ExactIrradiance, OfHarmonicsEqualsNumericIrradiance) {
    for (std::size_t degree = 1; degree <= 8; ++degree) expect_exact(SphericalHarmonics(degree), "convolution-signed");
}

TEST(ExactIrradiance, OfGaussiansEqualsNumericIrradiance) {
    for (const char* name : {"sg12", "sg12a", "sg12h", "sg40"})
        expect_exact(*(*SphericalGaussians::from_name(name))->linear(), "exact");
}

TEST(Irradiance, ClampedReadingIsTheSignedOneAboveZero) {
    const SphericalHarmonics basis(2);
    const std::vector<Rgb> c = [&] {
        std::vector<Rgb> result(basis.size());
        result[0] = {1, 1, 1};
        result[2] = {1, 3, -3};
        result[6] = {2, 0, 1};
        return result;
    }();
    const Directions normals = test::random_directions(Domain::sphere, 300, 6);
    Colours kept(300), clamped(300);
    irradiance(*basis.evaluator("convolution-signed"), c, normals, kept);
    irradiance(*basis.evaluator("convolution"), c, normals, clamped);
    EXPECT_LT(test::least(kept), 0);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(clamped.channel(k)[i], std::max(0.0f, kept.channel(k)[i]));
}

}  // namespace
}  // namespace lobelia
