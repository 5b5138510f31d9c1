// Tests the closed forms of bases against quadrature: Gram matrices, integrals, irradiance.
#include <gtest/gtest.h>

#include "core/basis/cosine_lobes.h"
#include "core/basis/hemisphere_polynomials.h"
#include "core/basis/icosahedron.h"
#include "core/basis/octahedral.h"
#include "lobelia/codec.h"
#include "support.h"

namespace lobelia {
namespace {

std::shared_ptr<const LinearBasis> linear(const std::string& name) { return as_linear(make_basis(name).value()); }

std::vector<std::string> linear_names() {
    std::vector<std::string> names;
    for (const auto& name : basis_names())
        if (make_basis(name).value()->linear()) names.push_back(name);
    return names;
}

/// Number of heights of the product rule that integrates the functions of a basis, and the relative error that remains:
/// functions with creases and steps converge slowly. Then the largest error of irradiance over its largest value.
struct Rule {
    std::size_t heights = 64;
    double error = 2e-6;
    double irradiance_error = 1e-4;
};
Rule rule_for(const std::string& name) {
    if (name.starts_with("ambient-cube") || name == "hl2" || name == "dice-srbf") return {256, 2e-5, 1e-4};
    if (name.starts_with("dice")) return {128, 1e-4, 2e-3};
    if (name.starts_with("oct")) return {128, 0.06, 3e-3};
    return {};
}

/// Keeps each test under ten seconds: bases with more functions are represented by smaller ones of their family.
constexpr std::size_t k_most_functions = 64;

TEST(EveryLinearBasis, GramAndIntegralsEqualQuadrature) {
    for (const auto& name : linear_names()) {
        const auto basis = linear(name);
        const std::size_t n = basis->size();
        if (n > k_most_functions) continue;
        const Rule rule = rule_for(name);
        const SphereRule points = product_rule(basis->domain(), rule.heights);
        const Matrix gram = basis->gram(), numeric = inner_products(*basis, *basis, points);
        const auto sums = basis->integrals(), numeric_sums = integrals(*basis, points);
        for (std::size_t i = 0; i < n; ++i) {
            const double norm = std::sqrt(gram[i * n + i]);
            EXPECT_NEAR(sums[i], numeric_sums[i], 4 * rule.error * norm) << name << " " << i;
            for (std::size_t j = 0; j < n; ++j) {
                EXPECT_NEAR(gram[i * n + j], numeric[i * n + j], rule.error * norm * std::sqrt(gram[j * n + j]))
                    << name << " " << i << " " << j;
                EXPECT_EQ(gram[i * n + j], gram[j * n + i]) << name;
            }
        }
    }
}

TEST(EveryLinearBasis, IsNonNegativeWhereItSaysSo) {
    for (const auto& name : linear_names()) {
        const auto basis = linear(name);
        const Directions directions = test::random_directions(basis->domain(), 256, 3);
        std::vector<float> rows(basis->size() * k_block_size);
        basis->values(directions, rows.data());
        const float least = *std::min_element(rows.begin(), rows.end());
        EXPECT_EQ(least >= 0, basis->is_non_negative()) << name;
    }
}

/// Integrates the radiance of the coefficients over the hemisphere about n.
Rgb numeric_irradiance(const Basis& basis, std::span<const Rgb> c, Vec3 n, const SphereRule& rule) {
    const Directions directions = test::turned(rule.directions, test::rotation_to(n));
    Colours radiance(directions.size());
    basis.radiance(c, directions, radiance);
    double sums[3] = {};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < directions.size(); ++j)
            sums[k] += rule.weights[j] * rule.directions.channel(2)[j] * radiance.channel(k)[j];
    return {static_cast<float>(sums[0]), static_cast<float>(sums[1]), static_cast<float>(sums[2])};
}

/// Coefficients of a small sky, and of a patch with a gradient.
std::vector<Rgb> some_coefficients(const std::shared_ptr<const Basis>& basis) {
    Accumulator accumulator(make_encoder(encoder_names(*basis).front(), basis).value());
    accumulator.add(test::samples_of(basis->domain(), 4096, [](Vec3 d) {
        const float a = dot(d, normalize(Vec3{1, 2, 3}));
        return Rgb{1 + d.x + 4 * std::exp(8 * (a - 1)), 0.5f + std::exp(8 * (a - 1)), 0.2f};
    }));
    return accumulator.solve();
}

TEST(EveryBasis, ExactIrradianceIsTheIntegralOfItsRadiance) {
    const SphereRule rule = product_rule(Domain::hemisphere, 128);
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const auto evaluator = basis->evaluator(basis->evaluator_names().back());
        if (evaluator->accuracy().reading != Reading::of_radiance) continue;
        const auto c = some_coefficients(basis);
        // Over the hemisphere, only the normal z receives all its light from the domain.
        Directions normals = test::random_directions(Domain::sphere, basis->domain() == Domain::sphere ? 20 : 1, 6);
        if (basis->domain() == Domain::hemisphere) set_entry(normals.view(), 0, Vec3{0, 0, 1});
        Colours E(normals.size());
        evaluator->signed_irradiance(c, normals, E);
        const double scale = test::largest(E);
        for (std::size_t j = 0; j < normals.size(); ++j) {
            const Rgb expected = numeric_irradiance(*basis, c, direction_at(normals, j), rule);
            EXPECT_LE(test::norm(colour_at(E.view(), j) - expected), rule_for(name).irradiance_error * scale)
                << name << " " << j;
        }
    }
}

// ---- Ambient dice ----

/// A spline of random values and slopes.
std::vector<Rgb> random_coefficients(std::size_t count) {
    std::mt19937 generator(4);
    const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
    std::vector<Rgb> c(count);
    for (Rgb& v : c) v = {uniform(), uniform(), uniform()};
    return c;
}

Rgb radiance_at(const Basis& basis, std::span<const Rgb> c, Vec3 w) {
    Directions one(1);
    set_entry(one.view(), 0, w);
    Colours out(1);
    basis.radiance(c, one, out);
    return colour_at(out.view(), 0);
}

TEST(AmbientDice, PassesThroughItsValuesAndSlopes) {
    const auto basis = make_basis("dice-bezier").value();
    const auto c = random_coefficients(36);
    for (std::size_t v = 0; v < 12; ++v) {
        const Vec3 at = icosahedron::vertices()[v];
        EXPECT_LE(test::norm(radiance_at(*basis, c, at) - c[3 * v]), 1e-5);
        // Compare slopes across the vertex in ten directions, on different faces: one tangent plane fits them all.
        const Vec3 u = normalize(cross(std::abs(at.z) < 0.5f ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, at)), w = cross(at, u);
        const float step = 0.01f;
        for (int k = 0; k < 10; ++k) {
            const auto x = static_cast<float>(std::cos(0.6 * k)), y = static_cast<float>(std::sin(0.6 * k));
            const Vec3 tangent = u * x + w * y;
            const Rgb ahead = radiance_at(*basis, c, normalize(at + tangent * step));
            const Rgb behind = radiance_at(*basis, c, normalize(at - tangent * step));
            const Rgb expected = c[3 * v + 1] * x + c[3 * v + 2] * y;
            EXPECT_LE(test::norm((ahead - behind) * (1 / (2 * step)) - expected), 0.03) << v << " " << k;
        }
    }
}

TEST(AmbientDice, IsSmoothAcrossEdges) {
    for (const char* name : {"dice-bezier", "dice-ycocg"}) {
        const auto basis = make_basis(name).value();
        auto c = random_coefficients(basis->size());
        // Chroma has creases.
        if (!basis->linear())
            for (std::size_t v = 0; v < 12; ++v) c[v] = {c[v].r, 0, 0};
        for (const auto& face : icosahedron::faces())
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 a = icosahedron::vertices()[face[k]], b = icosahedron::vertices()[face[(k + 1) % 3]];
                const Vec3 across = normalize(cross(a, b));
                for (const float s : {0.2f, 0.5f, 0.7f}) {
                    const Vec3 at = normalize(a * s + b * (1 - s));
                    const float step = 0.004f;
                    const auto value = [&](float x) { return radiance_at(*basis, c, normalize(at + across * x)).g; };
                    const float left = (value(-step) - value(-2 * step)) / step;
                    const float right = (value(2 * step) - value(step)) / step;
                    EXPECT_NEAR(value(1e-4f), value(-1e-4f), 1e-3) << name;
                    // Second derivatives of a few units, times the step between the two.
                    EXPECT_NEAR(left, right, 0.15) << name;
                }
            }
    }
}

// ---- Octahedral texels ----

TEST(Octahedral, CellsTileTheSphereAndHoldTheirPoints) {
    for (const std::size_t resolution : {2, 4, 8, 16, 64}) {
        const OctahedralMap map{resolution};
        double sum = 0;
        std::array<double, 3> first{};
        std::array<double, 6> second{};
        for (std::size_t i = 0; i < map.size(); ++i) {
            const auto cell = map.cell(i);
            sum += cell.solid_angle;
            for (std::size_t k = 0; k < 3; ++k) first[k] += cell.first_moment[k];
            for (std::size_t k = 0; k < 6; ++k) second[k] += cell.second_moment[k];
            const auto at = [&](double x, double y) {
                const auto n = static_cast<double>(resolution);
                return OctahedralMap::direction(2 * (static_cast<double>(i % resolution) + x) / n - 1,
                                                2 * (static_cast<double>(i / resolution) + y) / n - 1);
            };
            for (const double x : {0.01, 0.5, 0.99})
                for (const double y : {0.02, 0.51, 0.98}) EXPECT_EQ(map.index(at(x, y)), i) << resolution;
        }
        EXPECT_NEAR(sum, 4 * k_pi, 1e-11) << resolution;
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(first[k], 0, 1e-11) << resolution;
        // Four points a side of a triangle are exact to 1e-5 where cells are small.
        if (resolution < 8) continue;
        for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(second[k], k < 3 ? 4 * k_pi / 3 : 0, 1e-6) << resolution;
    }
}

TEST(Octahedral, CellMomentsEqualThoseOfManySmallOnes) {
    const OctahedralMap coarse{8}, fine{128};
    std::vector<OctahedralMap::Cell> sums(coarse.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const auto cell = fine.cell(i);
        auto& sum = sums[(i / fine.resolution / 16) * 8 + i % fine.resolution / 16];
        sum.solid_angle += cell.solid_angle;
        for (std::size_t k = 0; k < 3; ++k) sum.first_moment[k] += cell.first_moment[k];
        for (std::size_t k = 0; k < 6; ++k) sum.second_moment[k] += cell.second_moment[k];
    }
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto cell = coarse.cell(i);
        EXPECT_NEAR(cell.solid_angle, sums[i].solid_angle, 1e-12);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(cell.first_moment[k], sums[i].first_moment[k], 1e-12);
        for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(cell.second_moment[k], sums[i].second_moment[k], 1e-6);
    }
}

// ---- The hemisphere ----

TEST(HorizonIrradiance, EqualsQuadratureAtAnyNormal) {
    const SphereRule rule = product_rule(Domain::hemisphere, 300);
    const HorizonIrradiance irradiance(6);
    const Directions normals = test::random_directions(Domain::sphere, 20, 6);
    std::vector<float> rows(6 * k_block_size);
    irradiance.values(normals, rows.data());
    for (std::size_t j = 0; j < normals.size(); ++j) {
        const Vec3 n = direction_at(normals, j);
        double expected[6] = {};
        for (std::size_t q = 0; q < rule.weights.size(); ++q) {
            const Vec3 w = direction_at(rule.directions.view(), q);
            const double cosine = std::max(0.0f, dot(n, w)) * rule.weights[q];
            const double values[6] = {1, w.y, w.z, w.x, w.x * w.y, (w.x * w.x - w.y * w.y) / 2};
            for (std::size_t i = 0; i < 6; ++i) expected[i] += cosine * values[i];
        }
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(rows[i * k_block_size + j], expected[i], 5e-5) << "function " << i << " normal " << j;
    }
}

TEST(HemispherePolynomials, ProjectedIrradianceIsNearTheExactOne) {
    for (const std::size_t count : {4u, 6u}) {
        const HemispherePolynomials basis(count);
        const Directions normals = test::random_directions(Domain::hemisphere, 256, 6);
        std::vector<float> exact(count * k_block_size), projected(exact.size());
        basis.evaluator("exact")->weights()->values(normals, exact.data());
        basis.evaluator("projected")->weights()->values(normals, projected.data());
        double worst = 0;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < 256; ++j)
                worst = std::max(worst, std::abs(static_cast<double>(exact[i * k_block_size + j]) -
                                                 projected[i * k_block_size + j]));
        EXPECT_LT(worst, 0.18) << count;
        EXPECT_GT(worst, 0.15) << count;
    }
}

// ---- Clamped cosine powers ----

TEST(CosineLobes, ProductsEqualQuadratureOverBothDomains) {
    const SphereRule sphere = product_rule(Domain::sphere, 200), hemisphere = product_rule(Domain::hemisphere, 200);
    const Directions axes = test::random_directions(Domain::sphere, 12, 8);
    for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
        const SphereRule& rule = domain == Domain::sphere ? sphere : hemisphere;
        for (std::size_t i = 0; i < 12; i += 2)
            for (const auto powers : {std::array{2, 2}, {2, 4}, {4, 4}, {2, 0}}) {
                const Vec3 p = direction_at(axes, i), q = i == 0 ? p : direction_at(axes, i + 1);
                double sum = 0;
                for (std::size_t j = 0; j < rule.directions.size(); ++j) {
                    const Vec3 w = direction_at(rule.directions.view(), j);
                    const double a = dot(w, p), b = dot(w, q);
                    if (a > 0 && b > 0) sum += rule.weights[j] * std::pow(a, powers[0]) * std::pow(b, powers[1]);
                }
                EXPECT_NEAR(clamped_power_product(domain, {p, q}, powers), sum, powers[1] == 0 ? 2e-3 : 2e-5)
                    << i << " " << powers[0] << powers[1];
            }
    }
}

TEST(CosineLobes, KnownProducts) {
    const auto product = [](Vec3 p, Vec3 q) { return clamped_power_product(Domain::sphere, {p, q}, {2, 2}); };
    EXPECT_NEAR(product({1, 0, 0}, {1, 0, 0}), 2 * k_pi / 5, 1e-12);
    EXPECT_NEAR(product({1, 0, 0}, {0, 1, 0}), k_pi / 15, 1e-12);
    EXPECT_NEAR(product({1, 0, 0}, {-1, 0, 0}), 0, 1e-12);
}

TEST(Icosahedron, IsRegular) {
    const auto& v = icosahedron::vertices();
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_NEAR(length(v[i]), 1, 1e-6);
        EXPECT_EQ(v[i ^ 1], v[i] * -1.0f);
    }
    std::array<int, 12> uses{};
    for (const auto& face : icosahedron::faces()) {
        EXPECT_GT(dot(cross(v[face[0]], v[face[1]]), v[face[2]]), 0);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(dot(v[face[k]], v[face[(k + 1) % 3]]), 1 / std::sqrt(5.0), 1e-6);
            ++uses[face[k]];
        }
    }
    for (const int count : uses) EXPECT_EQ(count, 5);
}

}  // namespace
}  // namespace lobelia
