// Tests specular evaluators of spherical harmonics: exact limits, stated errors.
#include "core/basis/sh/sh_specular.h"

#include "core/math/ggx.h"
#include "core/math/harmonics.h"
#include "lobelia/codec.h"
#include "measure/study/specular_study.h"
#include "support.h"

namespace lobelia {
namespace {

/// Harmonic coefficients of ((1 + axis . w) / 2)^degree: a non-negative lobe of exactly this degree.
std::vector<Rgb> power_lobe(std::size_t degree, Vec3 axis) {
    const auto y = harmonics::values(degree, axis.x, axis.y, axis.z);
    const GaussLegendre rule(degree + 1);
    std::vector<Rgb> c(y.size());
    for (std::size_t l = 0, i = 0; l <= degree; ++l) {
        // Compute the zonal coefficient, 2 pi times the integral against P_l.
        double k = 0;
        for (std::size_t q = 0; q < rule.nodes.size(); ++q)
            k += 2 * k_pi * rule.weights[q] * std::pow((1 + rule.nodes[q]) / 2, degree) *
                 std::legendre(static_cast<unsigned>(l), rule.nodes[q]);
        for (; i < harmonics::coefficient_count(l); ++i) {
            const auto value = static_cast<float>(k * y[i]);
            c[i] = {value, 2 * value, 0.5f * value};
        }
    }
    return c;
}

/// RMS difference to the reference (many rays), over the RMS of the reference.
double specular_error(std::string_view name, std::size_t degree, std::span<const Rgb> c, const PointsAtAngle& points) {
    const auto basis = make_basis("sh" + std::to_string(degree)).value();
    return relative_specular_error(*make_specular(name, basis).value(), *make_sampled_specular(basis, 1024), c, points);
}

const Vec3 k_power_axis = normalize(Vec3{0.4f, -0.7f, 0.5f});

TEST(ShSpecular, ConvolutionIsExactToDegreeOne) {
    for (float alpha : {0.1f, 0.4f, 0.9f})
        for (float cosine : {0.2f, 0.6f, 1.0f})
            EXPECT_LT(
                specular_error("sh-convolution", 1, power_lobe(1, k_power_axis), PointsAtAngle(40, cosine, alpha)),
                3e-3)
                << alpha << " " << cosine;
}

TEST(ShSpecular, ConvolutionIsExactAlongTheNormal) {
    for (float alpha : {0.1f, 0.4f, 0.9f})
        for (std::size_t degree : {2u, 4u, 8u})
            EXPECT_LT(
                specular_error("sh-convolution", degree, power_lobe(degree, k_power_axis), PointsAtAngle(40, 1, alpha)),
                6e-3)
                << alpha << " " << degree;
}

TEST(ShSpecular, PrefilteredIsExactAlongTheNormal) {
    EXPECT_LT(specular_error("sh-prefiltered", 4, power_lobe(4, k_power_axis), PointsAtAngle(40, 1, 0.4f)), 6e-3);
}

TEST(ShSpecular, MirrorReflectsTheRadiance) {
    const auto c = power_lobe(4, k_power_axis);
    const auto basis = make_basis("sh4").value();
    const PointsAtAngle points(60, 0.5f, 0);
    Directions mirrored(60);
    for (std::size_t i = 0; i < 60; ++i) {
        const Vec3 n = direction_at(points.normals, i), v = direction_at(points.views, i);
        set_entry(mirrored, i, n * (2 * dot(n, v)) - v);
    }
    Colours out(60), radiance(60);
    basis->radiance(c, mirrored, radiance);
    for (const char* name : {"sh-convolution", "sh-prefiltered"}) {
        make_specular(name, basis).value()->reflected(c, points.view(), out);
        for (std::size_t i = 0; i < 60; ++i) EXPECT_NEAR(colour_at(out, i).r, colour_at(radiance, i).r, 0.01) << name;
    }
}

TEST(ShSpecular, WhiteFurnace) {
    for (const auto& name : sh_specular_names())
        for (float alpha : {0.1f, 0.5f, 1.0f}) {
            const PointsAtAngle points(5, 0.3f, alpha);
            std::vector<Rgb> c(9);
            c[0] = Rgb{1, 1, 1} * std::sqrt(4 * static_cast<float>(k_pi));
            Colours out(5);
            sh_specular(name, 2)->reflected(c, points.view(), out);
            EXPECT_NEAR(colour_at(out, 3).r, ggx::lobe(ggx::make_view(0.3f, alpha)).albedo, 1e-3) << name;
        }
}

TEST(ShSpecular, DominantIsExactForOneLamp) {
    // Degree 1 of a directional light whose irradiance across the beam is 1.
    const auto y = harmonics::values(1, k_power_axis.x, k_power_axis.y, k_power_axis.z);
    std::vector<Rgb> c(4);
    for (std::size_t i = 0; i < 4; ++i) c[i] = Rgb{1, 1, 1} * static_cast<float>(y[i]);
    const PointsAtAngle points(40, 0.5f, 0.3f);
    Colours out(40);
    sh_specular("sh-dominant", 1)->reflected(c, points.view(), out);
    for (std::size_t i = 0; i < 40; ++i) {
        const auto view = ggx::make_view(direction_at(points.normals, i), direction_at(points.views, i), 0.3f);
        const double exact = ggx::reflection(view, view.to_local(k_power_axis));
        EXPECT_NEAR(colour_at(out, i).g, exact, 1e-3 + 2e-3 * exact);
    }
}

// The stated errors: a lobe of degrees 2 to 8, alpha 0.1 to 0.8, n.v 0.25 to 1.
TEST(ShSpecular, WithinStatedErrors) {
    double convolution = 0, prefiltered = 0;
    for (float alpha : {0.1f, 0.3f, 0.8f})
        for (float cosine : {0.25f, 0.6f, 0.95f})
            for (std::size_t degree : {2u, 4u, 8u}) {
                const auto c = power_lobe(degree, k_power_axis);
                const PointsAtAngle points(100, cosine, alpha);
                convolution = std::max(convolution, specular_error("sh-convolution", degree, c, points));
                prefiltered = std::max(prefiltered, specular_error("sh-prefiltered", degree, c, points));
            }
    EXPECT_LT(convolution, 0.13);
    EXPECT_LT(prefiltered, 0.7);
    EXPECT_GT(prefiltered, convolution);
}

}  // namespace
}  // namespace lobelia
