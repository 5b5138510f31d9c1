// Packings of coefficients in textures: what is packed comes back, and shaders read from it what evaluators do.
#include <gtest/gtest.h>

#include <set>

#include "lobelia/codec.h"
#include "support.h"

namespace lobelia {
namespace {

/// Coefficients of light: encoded samples of a small sky.
std::vector<Rgb> coefficients_of(const std::shared_ptr<const Basis>& basis) {
    Accumulator accumulator(make_encoder("moments", basis).value());
    accumulator.add(texel_samples(test::small_sky(), basis->domain()));
    return accumulator.solve();
}

std::size_t layers_of(const TexturePacking& packing) {
    std::size_t layers = 0;
    for (const auto& array : packing.textures()) layers += array.layers.size();
    return layers;
}

TEST(TexturePacking, RoundTripOfEveryPackingOfEveryBasis) {
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const std::vector<Rgb> c = coefficients_of(basis);
        std::set<std::string> names;
        const auto packings = basis->packings();
        ASSERT_FALSE(packings.empty());
        for (const auto& packing : packings) {
            SCOPED_TRACE(name + " " + packing->name());
            EXPECT_TRUE(names.insert(packing->name()).second);
            EXPECT_FALSE(packing->reading().empty());
            ASSERT_EQ(packing->coefficients(), basis->size());
            std::vector<Rgb> layers(layers_of(*packing)), back(c.size());
            packing->pack(c, layers);
            packing->unpack(layers, back);
            EXPECT_LE(test::distance(back, c), 1e-6 * test::norm(c));
        }
    }
}

TEST(TexturePacking, BytesHoldNumbersBetween0And1WhateverTheCoefficients) {
    std::mt19937 generator(1);
    std::normal_distribution<float> normal;
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        for (const auto& packing : basis->packings())
            for (int i = 0; i < 1000; ++i) {
                std::vector<Rgb> c(basis->size()), layers(layers_of(*packing));
                for (Rgb& v : c) v = {normal(generator), normal(generator), normal(generator) * (i % 2 ? 1.0f : 0.0f)};
                packing->pack(c, layers);
                EXPECT_TRUE(test::all_finite(layers));
                std::size_t layer = 0;
                for (const auto& array : packing->textures())
                    for (std::size_t k = 0; k < array.layers.size(); ++k, ++layer) {
                        if (array.format != TexelFormat::unorm8) continue;
                        for (float v : {layers[layer].r, layers[layer].g, layers[layer].b})
                            EXPECT_TRUE(v >= 0 && v <= 1) << packing->name() << ": " << v;
                    }
            }
    }
}

/// The degree-1 packing.
struct RelativeBand {
    std::shared_ptr<const Basis> basis = make_basis("sh1").value();
    std::shared_ptr<const TexturePacking> packing = basis->packings().at(1);
};

TEST(TexturePacking, ShadersReadTheIrradianceOfTheRelativeBand) {
    const RelativeBand band;
    EXPECT_EQ(band.packing->name(), "l1-over-l0");
    const std::vector<Rgb> c = coefficients_of(band.basis);
    std::array<Rgb, 4> t;
    band.packing->pack(c, t);
    const auto evaluator = band.basis->evaluator("convolution-signed");
    const Directions normals = test::random_directions(Domain::sphere, 500, 2);
    Colours expected(normals.size()), read(normals.size());
    irradiance(*evaluator, c, normals, expected);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3 n = direction_at(normals, i);
        const auto e = [&](float Rgb::*k) {
            const Vec3 l1{2 * t[1].*k - 1, 2 * t[2].*k - 1, 2 * t[3].*k - 1};
            return static_cast<float>(k_pi) * 2 * (t[0].*k) * (0.5f + dot(l1, n));
        };
        set_entry(read.view(), i, Rgb{e(&Rgb::r), e(&Rgb::g), e(&Rgb::b)});
    }
    EXPECT_LE(test::largest_difference(read, expected), 3e-6 * test::largest(expected));
}

TEST(TexturePacking, OneDirectionOfLightIsTheEndOfTheRelativeBandsRange) {
    // All light from one direction: L1 has length 1. None: length 0, and the middle of the range.
    const RelativeBand band;
    for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, 0, -1}, normalize(Vec3{1, 2, -3})}) {
        const std::array<Rgb, 4> c = [&] {
            Directions one(1);
            set_entry(one.view(), 0, d);
            std::vector<float> rows(4 * k_block_size);
            band.basis->linear()->values(one, rows.data());
            std::array<Rgb, 4> result;
            for (std::size_t i = 0; i < 4; ++i) {
                const float y = rows[i * k_block_size];
                result[i] = {3 * y, y, 0};
            }
            return result;
        }();
        std::array<Rgb, 4> t;
        band.packing->pack(c, t);
        EXPECT_NEAR(2 * t[1].r - 1, d.x, 1e-6);
        EXPECT_NEAR(2 * t[2].r - 1, d.y, 1e-6);
        EXPECT_NEAR(2 * t[3].g - 1, d.z, 1e-6);
        EXPECT_EQ(t[1].b, 0.5f);
        EXPECT_EQ(t[0].b, 0);
    }
}

}  // namespace
}  // namespace lobelia
