// Shader code at coefficients on the edges of a formula: without a vector, without a mean, with a negative mean.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "glossy_points.h"
#include "lobelia/codec.h"
#include "shader_cases.h"
#include "support.h"

namespace lobelia {
namespace {

/// Degree 1 as harmonics have it in coefficients 0 to 3, and whatever follows.
const std::set<std::string, std::less<>> k_harmonic_bases = {"sh1", "sh2", "zh3", "zh3-rgb", "sh1h", "irradz"};

struct EdgeTexel {
    const char* name;
    std::vector<Rgb> c;
};

std::vector<EdgeTexel> edge_texels(std::size_t size) {
    std::vector<Rgb> plain;
    for (std::size_t i = 0; i < size; ++i) {
        const auto k = static_cast<float>(i);
        plain.push_back(i == 0 ? Rgb{3, 2, 1} : Rgb{std::sin(k), std::cos(3 * k), 0.5f * std::sin(5 * k)});
    }
    std::vector<EdgeTexel> texels(7, {"plain", plain});
    texels[1].name = "black";
    texels[1].c.assign(size, Rgb{});
    texels[2].name = "no vector in any channel";
    for (std::size_t i = 1; i < 4; ++i) texels[2].c[i] = {};
    texels[3].name = "no vector in one channel";
    for (std::size_t i = 1; i < 4; ++i) texels[3].c[i].r = 0;
    texels[4].name = "a negative mean in one channel";
    texels[4].c[0].g = -2;
    texels[5].name = "a vector without a mean";
    texels[5].c[0].b = 0;
    texels[6].name = "a bright vector without a mean";
    for (Rgb& c : texels[6].c) c = c * 1e12f;
    texels[6].c[0].b = 0;
    return texels;
}

TEST(ShaderParity, EdgesOfFormulaeGiveWhatTheLibraryGives) {
    const test::GlossyPoints points(Domain::sphere, 256);
    const std::vector<float> floats = points.floats();
    const Directions& directions = points.normals;
    std::size_t tested = 0;
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if (!k_harmonic_bases.contains(shader.basis) || test::unpacks(shader)) continue;
        const auto basis = make_basis(shader.basis).value();
        for (const EdgeTexel& texel : edge_texels(basis->size())) {
            const Codec codec = test::codec_of(shader);
            Colours expected(directions.size());
            if (test::reflects(shader))
                specular(*make_specular(shader.part, basis).value(), texel.c, points.points(), points.f0, expected);
            else if (std::string_view(shader.function) == "irradiance")
                codec.irradiance(texel.c, directions, expected);
            else
                codec.radiance(texel.c, directions, expected);
            double largest = 1e-30, off = 0;
            for (std::size_t j = 0; j < directions.size(); ++j) {
                const Vec3 d = direction_at(directions.view(), j);
                float out[3];
                shader.call(&texel.c[0].r, test::reflects(shader) ? &floats[test::k_point_floats * j] : &d.x, out);
                for (std::size_t k = 0; k < 3; ++k) {
                    const double value = expected.channel(k)[j], error = std::abs(out[k] - value);
                    largest = std::max(largest, std::abs(value));
                    off = error <= off ? off : error;  // a NaN becomes the worst
                }
            }
            EXPECT_LT(off / largest, 2e-5)
                << shader.basis << " " << shader.part << " " << shader.function << ": " << texel.name;
            ++tested;
        }
    }
    EXPECT_GT(tested, 7u * 20);
}

TEST(ShaderParity, TheHorizonHoldsAtThePoles) {
    // Where the angle between the normal and z is nearly 0 or pi, errors of its sine and arc cosine must cancel.
    std::size_t tested = 0;
    for (const test::ShaderCase& shader : test::shader_cases()) {
        if ((std::string_view(shader.basis) != "h4" && std::string_view(shader.basis) != "h6") ||
            std::string_view(shader.part) != "exact")
            continue;
        ++tested;
        const auto evaluator = make_basis(shader.basis).value()->evaluator("exact");
        const std::vector<Rgb> c(make_basis(shader.basis).value()->size(), Rgb{1, -0.5f, 2});
        for (int i = 0; i < 40; ++i) {
            const Vec3 n = normalize({std::pow(10.0f, -0.1f * static_cast<float>(i)), 0, i % 2 == 0 ? 1.0f : -1.0f});
            float out[3];
            shader.call(&c[0].r, &n.x, out);
            EXPECT_NEAR(out[2], evaluator->signed_irradiance_at(c, n).b, 2e-5 * 10) << shader.basis << " " << n.x;
        }
    }
    EXPECT_EQ(tested, 2u);
}

}  // namespace
}  // namespace lobelia
