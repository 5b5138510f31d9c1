// Tests that spherical harmonics are orthonormal, rotate as functions do, and convolve with the clamped cosine as
// published.
#include "core/math/harmonics.h"

#include <gtest/gtest.h>

#include "support.h"

namespace lobelia {
namespace {

TEST(Harmonics, Orthonormal) {
    const harmonics::Harmonics basis(8);
    const Matrix gram = inner_products(basis, basis, product_rule(Domain::sphere, 12));
    for (std::size_t i = 0; i < basis.size(); ++i)
        for (std::size_t j = 0; j < basis.size(); ++j)
            EXPECT_NEAR(gram[i * basis.size() + j], i == j ? 1 : 0, 1e-6) << i << " " << j;
}

TEST(Harmonics, LowDegreesEqualTheirPolynomials) {
    // All-plus signs, index l^2 + l + m.
    const Directions directions = test::random_directions(Domain::sphere, 100, 1);
    const harmonics::Harmonics basis(2);
    std::vector<float> rows(9 * k_block_size);
    basis.values(directions, rows.data());
    for (std::size_t j = 0; j < 100; ++j) {
        const Vec3 d = direction_at(directions, j);
        const double x = d.x, y = d.y, z = d.z, k1 = std::sqrt(3 / (4 * k_pi)), k2 = std::sqrt(15 / (4 * k_pi));
        const double expected[9] = {std::sqrt(1 / (4 * k_pi)),
                                    k1 * y,
                                    k1 * z,
                                    k1 * x,
                                    k2 * x * y,
                                    k2 * y * z,
                                    std::sqrt(5 / (16 * k_pi)) * (3 * z * z - 1),
                                    k2 * x * z,
                                    k2 * (x * x - y * y) / 2};
        const auto oracle = harmonics::values(2, x, y, z);
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_NEAR(rows[i * k_block_size + j], expected[i], 1e-6) << i;
            EXPECT_NEAR(oracle[i], expected[i], 1e-6) << i;  // the float32 direction is not an exact unit vector
        }
    }
}

TEST(Harmonics, RecurrenceEqualsTheDoubleOracle) {
    for (std::size_t degree = 0; degree <= 8; ++degree) {
        const harmonics::Harmonics basis(degree);
        ASSERT_EQ(basis.size(), harmonics::coefficient_count(degree));
        Directions directions = test::random_directions(Domain::sphere, 250, 2);
        const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
        for (std::size_t i = 0; i < 6; ++i) set_entry(directions.view(), i, axes[i]);
        std::vector<float> rows(basis.size() * k_block_size);
        basis.values(directions, rows.data());
        for (std::size_t j = 0; j < directions.size(); ++j) {
            const Vec3 d = direction_at(directions, j);
            const auto expected = harmonics::values(degree, d.x, d.y, d.z);
            for (std::size_t i = 0; i < basis.size(); ++i)
                ASSERT_NEAR(rows[i * k_block_size + j], expected[i], 4e-6) << i << " of degree " << degree;
        }
    }
}

TEST(Harmonics, BandsHaveConstantPower) {
    // Addition theorem: sum over m of Y_lm^2 = (2l + 1) / (4 pi).
    const Directions directions = test::random_directions(Domain::sphere, 50, 3);
    for (std::size_t j = 0; j < 50; ++j) {
        const Vec3 d = direction_at(directions, j);
        const auto y = harmonics::values(8, d.x, d.y, d.z);
        for (std::size_t l = 0; l <= 8; ++l) {
            double sum = 0;
            for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) sum += y[i] * y[i];
            EXPECT_NEAR(sum, static_cast<double>(2 * l + 1) / (4 * k_pi), 1e-12) << l;
        }
    }
}

TEST(ClampedCosine, IsThePrintedListAndTheNumericIntegral) {
    const double printed[] = {k_pi, 2 * k_pi / 3, k_pi / 4, 0, -k_pi / 24, 0, k_pi / 64, 0};
    for (std::size_t l = 0; l < 8; ++l) EXPECT_NEAR(harmonics::clamped_cosine(l), printed[l], 1e-15);
    const GaussLegendre rule(64, 0, 1);
    for (unsigned l = 0; l <= 60; ++l) {
        double expected = 0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i)
            expected += 2 * k_pi * rule.weights[i] * rule.nodes[i] * std::legendre(l, rule.nodes[i]);
        EXPECT_NEAR(harmonics::clamped_cosine(l), expected, 1e-13) << l;
    }
}

const std::vector<Rotation>& rotations() {
    static const std::vector<Rotation> list = {test::some_rotation(),
                                               test::about_z(0.7),
                                               rotation_about({1, 0, 0}, k_pi / 2),
                                               rotation_about({0, 1, 0}, k_pi),
                                               rotation_about(normalize(Vec3{-1, 2, 0.1f}), -2.9),
                                               {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    return list;
}

TEST(HarmonicRotation, RotatedFunctionIsTheFunctionElsewhere) {
    for (std::size_t degree = 0; degree <= 8; ++degree)
        for (const Rotation& r : rotations()) {
            const auto c = test::random_colours(harmonics::coefficient_count(degree), 5);
            const auto turned = harmonics::rotated(r, c);
            const harmonics::Harmonics basis(degree);
            const Directions directions = test::random_directions(Domain::sphere, 100, 4);
            Colours before(100), after(100);
            evaluate(basis, c, directions, before);
            evaluate(basis, turned, test::turned(directions, r), after);
            EXPECT_LE(test::largest_difference(before, after), 3e-6 * test::norm(c)) << degree;
        }
}

/// Applies rotation_matrix band by band.
std::vector<Rgb> rotated_by_matrices(const Rotation& r, const std::vector<Rgb>& c) {
    std::vector<Rgb> result(c.size());
    for (std::size_t l = 0; l * l < c.size(); ++l) {
        const std::size_t size = 2 * l + 1;
        const Matrix m = harmonics::rotation_matrix(r, l);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j)
                result[l * l + i] = result[l * l + i] + c[l * l + j] * static_cast<float>(m[i * size + j]);
    }
    return result;
}

TEST(HarmonicRotation, SpecialAndGeneralFormsAgree) {
    for (const Rotation& r : rotations())
        for (std::size_t degree = 0; degree <= 4; ++degree) {
            const auto c = test::random_colours(harmonics::coefficient_count(degree), 6);
            EXPECT_LE(test::distance(harmonics::rotated(r, c), rotated_by_matrices(r, c)), 1e-6 * test::norm(c))
                << degree;
        }
}

TEST(HarmonicRotation, MatricesAreOrthogonal) {
    for (const Rotation& r : rotations())
        for (std::size_t l = 0; l <= 8; ++l) {
            const std::size_t size = 2 * l + 1;
            const Matrix m = harmonics::rotation_matrix(r, l);
            for (std::size_t i = 0; i < size; ++i)
                for (std::size_t j = 0; j < size; ++j) {
                    double sum = 0;
                    for (std::size_t k = 0; k < size; ++k) sum += m[i * size + k] * m[j * size + k];
                    EXPECT_NEAR(sum, i == j ? 1 : 0, 2e-6) << "degree " << l;  // the rotation itself is float32
                }
        }
}

TEST(HarmonicRotation, CompositionIsOneRotation) {
    const Rotation a = test::some_rotation(), b = rotation_about({0, 1, 0}, 2.2);
    // (a b) v = a (b v): the columns of the product are a times those of b.
    Rotation ab{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 row = a[i];
        ab[i] = {row.x * b[0].x + row.y * b[1].x + row.z * b[2].x, row.x * b[0].y + row.y * b[1].y + row.z * b[2].y,
                 row.x * b[0].z + row.y * b[1].z + row.z * b[2].z};
    }
    const auto c = test::random_colours(harmonics::coefficient_count(8), 7);
    EXPECT_LE(test::distance(harmonics::rotated(ab, c), harmonics::rotated(a, harmonics::rotated(b, c))),
              3e-6 * test::norm(c));
    EXPECT_GE(test::distance(harmonics::rotated(ab, c), harmonics::rotated(b, harmonics::rotated(a, c))),
              0.1 * test::norm(c));
}

TEST(HarmonicRotation, KeepsTheNormOfEachBand) {
    const auto c = test::random_colours(harmonics::coefficient_count(8), 8);
    const auto turned = harmonics::rotated(test::some_rotation(), c);
    for (std::size_t l = 0; l <= 8; ++l) {
        const auto band = [&](const std::vector<Rgb>& v) {
            return test::norm(std::vector<Rgb>(v.begin() + static_cast<std::ptrdiff_t>(l * l),
                                               v.begin() + static_cast<std::ptrdiff_t>((l + 1) * (l + 1))));
        };
        EXPECT_NEAR(band(turned), band(c), 1e-6 * band(c)) << l;
    }
}

}  // namespace
}  // namespace lobelia
