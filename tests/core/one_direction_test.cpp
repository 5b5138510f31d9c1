// Tests that evaluation at one direction, at places with their own coefficients, from views of the caller's memory and
// from packed textures agrees with the batch.
#include <gtest/gtest.h>

#include <random>

#include "lobelia/bases.h"
#include "lobelia/codec.h"
#include "lobelia/encoders.h"
#include "lobelia/evaluate.h"
#include "lobelia/storage.h"
#include "support.h"

namespace lobelia {
namespace {

std::vector<std::string> tested_bases() {
    std::vector<std::string> names = basis_names();
    names.insert(names.end(), {"sg12a", "sg7@100", "sg40h", "oct2", "sgfit1"});
    return names;
}

/// Returns coefficients that an encoder computes for the sky.
std::vector<Rgb> coefficients(const std::shared_ptr<const Basis>& basis) {
    Accumulator accumulator(make_encoder(encoder_names(*basis).front(), basis).value());
    accumulator.add(directed_samples(sky({64, 32}), test::random_directions(basis->domain(), 500, 3), basis->domain()));
    return accumulator.solve();
}

float largest(std::span<const Rgb> c) {
    float most = 0;
    for (const Rgb v : c) most = std::max({most, std::abs(v.r), std::abs(v.g), std::abs(v.b)});
    return most;
}

void expect_near(Rgb a, Rgb b, float tolerance, const std::string& what) {
    EXPECT_NEAR(a.r, b.r, tolerance) << what;
    EXPECT_NEAR(a.g, b.g, tolerance) << what;
    EXPECT_NEAR(a.b, b.b, tolerance) << what;
}

TEST(OneDirection, EqualsTheBatch) {
    constexpr std::size_t count = 37;
    for (const auto& name : tested_bases()) {
        const auto basis = make_basis(name).value();
        const auto c = coefficients(basis);
        const Directions directions = test::random_directions(Domain::sphere, count, 5);
        Colours batch(count);
        basis->radiance(c, directions, batch);
        // Allow for rounding: both forms sum the same products, in another order.
        const float tolerance = 3e-6f * largest(c) * static_cast<float>(std::sqrt(c.size()));
        for (std::size_t j = 0; j < count; ++j)
            expect_near(basis->radiance_at(c, direction_at(directions, j)), colour_at(batch, j), tolerance, name);
        for (const auto& evaluator_name : basis->evaluator_names()) {
            const auto evaluator = make_evaluator(evaluator_name, *basis).value();
            irradiance(*evaluator, c, directions, batch);
            for (std::size_t j = 0; j < count; ++j)
                expect_near(irradiance(*evaluator, c, direction_at(directions, j)), colour_at(batch, j),
                            static_cast<float>(k_pi) * tolerance, name + " " + evaluator_name);
        }
    }
}

TEST(OneDirection, ValuesEqualTheRows) {
    const auto expect_values = [](const FunctionSet& functions, const std::string& what) {
        const Directions directions = test::random_directions(Domain::sphere, 19, 5);
        std::vector<float> rows(functions.size() * k_block_size), values(round_up_to_lanes(functions.size()));
        functions.values(directions, rows.data());
        for (std::size_t j = 0; j < directions.size(); ++j) {
            functions.values_at(direction_at(directions, j), values.data());
            for (std::size_t i = 0; i < functions.size(); ++i)
                EXPECT_NEAR(values[i], rows[i * k_block_size + j], 2e-6f * (1 + std::abs(values[i]))) << what;
        }
    };
    for (const auto& name : tested_bases()) {
        const auto basis = make_basis(name).value();
        if (basis->linear()) expect_values(*basis->linear(), name);
        for (const auto& evaluator : basis->evaluator_names())
            if (const auto made = basis->evaluator(evaluator); made->weights())
                expect_values(*made->weights(), name + " " + evaluator);
    }
}

TEST(OneDirection, CodecsClampAsTheyDoInBatches) {
    for (const char* name : {"sh2/moments/convolution", "sh2/moments/convolution-signed", "sg12/moments/hill"}) {
        const Codec codec = make_codec(name).value();
        std::vector<Rgb> c(codec.basis().size());
        const Directions any = test::random_directions(Domain::sphere, c.size(), 4);
        for (std::size_t i = 0; i < c.size(); ++i) c[i] = {any.channel(0)[i], any.channel(1)[i], -1};
        const Directions directions = test::random_directions(Domain::sphere, 50, 6);
        Colours e(50), l(50);
        codec.irradiance(c, directions, e);
        codec.radiance(c, directions, l);
        for (std::size_t j = 0; j < 50; ++j) {
            expect_near(codec.irradiance(c, direction_at(directions, j)), colour_at(e, j), 1e-4f, name);
            expect_near(codec.radiance(c, direction_at(directions, j)), colour_at(l, j), 1e-4f, name);
        }
    }
}

TEST(OwnCoefficients, EqualEachPlaceAlone) {
    // Use more than a block, and not a whole number of lanes.
    constexpr std::size_t count = 2 * k_block_size + 19;
    for (const char* name : {"sh1/moments/geomerics", "sh2/moments/convolution", "sg12/moments/hill",
                             "sg12h/moments/exact", "zh3/moments/convolution", "ambient-cube/moments/squares"}) {
        const Codec codec = make_codec(name).value();
        std::vector<std::vector<float>> planes(3 * codec.basis().size());
        std::vector<const float*> pointers;
        std::mt19937 generator(9);
        for (auto& plane : planes) {
            for (std::size_t j = 0; j < count; ++j) plane.push_back(static_cast<float>(generator()) * 0x1p-32f);
            pointers.push_back(plane.data());
        }
        const Directions directions = test::random_directions(codec.basis().domain(), count, 3);
        Colours e(count), l(count);
        irradiance(codec.evaluator(), pointers, directions, e);
        radiance(codec.basis(), pointers, directions, l);
        for (std::size_t j = 0; j < count; j += 7) {
            std::vector<Rgb> c;
            for (std::size_t i = 0; i < planes.size(); i += 3)
                c.push_back({planes[i][j], planes[i + 1][j], planes[i + 2][j]});
            const Vec3 w = direction_at(directions, j);
            expect_near(colour_at(e, j), irradiance(codec.evaluator(), c, w), 1e-5f, name);
            expect_near(colour_at(l, j), codec.basis().radiance_at(c, w), 1e-5f, name);
        }
    }
}

TEST(Views, OfTheCallersArraysAreNotTouchedBeyondTheirEnd) {
    // Use arrays of exactly `count` floats, with sentinels that sums must not include and stores must not change.
    for (const std::size_t count : {1u, 3u, 15u, 16u, 17u, 300u}) {
        const Samples samples =
            directed_samples(sky({64, 32}), test::random_directions(Domain::sphere, count, 3), Domain::sphere);
        std::array<std::vector<float>, 7> channels;
        SampleView own;
        for (std::size_t k = 0; k < 7; ++k) {
            channels[k].assign(samples.view().channel(k), samples.view().channel(k) + count);
            channels[k].resize(count + k_lanes, NAN);
            own.pointers[k] = channels[k].data();
        }
        own.size = count;
        for (const auto& name : encoder_names()) {
            const auto encoder = make_encoder(name, make_basis("sg12").value()).value();
            Accumulator one(encoder), other(encoder);
            one.add(samples);
            other.add(own);
            EXPECT_EQ(one.solve(), other.solve()) << name << " " << count;
        }
        std::vector<float> out(3 * (count + k_lanes), 7.0f);
        const MutableColourView e{{out.data(), out.data() + count + k_lanes, out.data() + 2 * (count + k_lanes)},
                                  count};
        Colours expected(count);
        for (const char* name : {"sh2", "sg12", "h6", "ambient-cube", "oct8", "zh3", "ahd", "dice-bezier"}) {
            const auto basis = make_basis(name).value();
            const auto c = coefficients(basis);
            const auto evaluator = basis->evaluator(basis->evaluator_names().front());
            irradiance(*evaluator, c, own.directions(), e);
            irradiance(*evaluator, c, samples.view().directions(), expected);
            for (std::size_t j = 0; j < count; ++j)
                EXPECT_EQ(colour_at(e, j), colour_at(expected, j)) << name << " " << count;
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t j = count; j < count + k_lanes; ++j) ASSERT_EQ(e.channel(k)[j], 7.0f) << name;
        }
    }
}

TEST(TextureSampler, GivesBackWhatUnpackGivesAtTexelCentres) {
    constexpr std::size_t width = 9, height = 6, coefficients = 4;
    const CoefficientTraits traits{coefficients, true, true, std::vector<float>(coefficients, 1.0f)};
    std::vector<std::vector<float>> in(3 * coefficients, std::vector<float>(width * height)), back = in;
    std::mt19937 generator(2);
    for (std::size_t p = 0; p < in.size(); ++p)
        for (float& v : in[p]) v = (p < 3 ? 1.0f : 0.0f) + 0.9f * static_cast<float>(generator()) * 0x1p-32f;
    for (const Storage& storage : storages()) {
        const TextureLayout layout = storage.layout(traits);
        const auto packed =
            pack(layout, CoefficientPlanes(width, height, std::span<const std::vector<float>>(in), coefficients));
        unpack(layout, packed,
               MutableCoefficientPlanes(width, height, std::span<std::vector<float>>(back), coefficients));
        const auto sampler = TextureSampler::make(layout, packed);
        ASSERT_TRUE(sampler) << storage.name;
        // The sampler blends sub-sampled textures, but unpack() uses the nearest texel.
        const bool blended = std::any_of(layout.textures.begin(), layout.textures.end(),
                                         [](const auto& texture) { return texture.subsampling > 1; });
        for (std::size_t j = 0; j < width * height && !blended; ++j) {
            std::vector<Rgb> c(coefficients);
            sampler->sample(
                {(static_cast<float>(j % width) + 0.5f) / width, (static_cast<float>(j / width) + 0.5f) / height}, c);
            for (std::size_t i = 0; i < coefficients; ++i)
                expect_near(c[i], {back[3 * i][j], back[3 * i + 1][j], back[3 * i + 2][j]}, 2e-5f,
                            std::string(storage.name));
        }
    }
}

TEST(TextureSampler, BlendsLinearlyAndClampsAtTheEdges) {
    // Bilinear lookups preserve a plane of constant slope, including chroma of 2 x 2 texels.
    constexpr std::size_t width = 16, height = 8;
    const CoefficientTraits traits{1, true, true, {1.0f}};
    std::vector<std::vector<float>> in(3, std::vector<float>(width * height));
    const auto value = [](float x, float y, std::size_t k) {
        return 1 + 0.25f * x + 0.125f * y + static_cast<float>(k);
    };
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < width * height; ++j)
            in[k][j] = value(static_cast<float>(j % width) + 0.5f, static_cast<float>(j / width) + 0.5f, k);
    for (const char* name : {"float32", "ycocg"}) {
        const TextureLayout layout = find_storage(name).value()->layout(traits);
        const auto packed = pack(layout, CoefficientPlanes(width, height, std::span<const std::vector<float>>(in), 1));
        const auto sampler = TextureSampler::make(layout, packed).value();
        for (const Vec2 at : {Vec2{3.2f, 4.9f}, {8, 4}, {12.75f, 1.5f}}) {
            Rgb c;
            sampler.sample({at.x / width, at.y / height}, {&c, 1});
            expect_near(c, {value(at.x, at.y, 0), value(at.x, at.y, 1), value(at.x, at.y, 2)}, 4e-3f, name);
        }
        Rgb corner, outside;
        sampler.sample({0, 1}, {&corner, 1});
        sampler.sample({-3, 7}, {&outside, 1});
        EXPECT_EQ(corner, outside);
    }
}

TEST(TextureSampler, RefusesTexturesOfAnotherLayout) {
    const CoefficientTraits traits{2, true, true, {1, 1}};
    const std::vector<float> plane(4, 1.0f);
    const CoefficientPlanes planes(2, 2, std::vector<const float*>(6, plane.data()));
    const TextureLayout layout = find_storage("float16").value()->layout(traits);
    auto packed = pack(layout, planes);
    EXPECT_TRUE(TextureSampler::make(layout, packed));
    EXPECT_FALSE(TextureSampler::make(layout, std::span(packed).first(packed.size() - 1)));
    packed.front().data.pop_back();
    EXPECT_FALSE(TextureSampler::make(layout, packed));
}

TEST(TextureSampler, EvaluatesAtAPlaceAndANormal) {
    const Codec codec = make_codec(spherical_harmonics(1), "moments", "convolution").value();
    const auto traits = coefficient_traits(*codec.encoder());
    const auto c = coefficients(spherical_harmonics(1));
    std::vector<float> values;
    for (const Rgb v : c) values.insert(values.end(), {v.r, v.g, v.b});
    std::vector<const float*> pointers;
    for (const float& v : values) pointers.push_back(&v);
    const TextureLayout layout = find_storage("float32").value()->layout(traits);
    const auto packed = pack(layout, CoefficientPlanes(1, 1, pointers));
    const auto sampler = TextureSampler::make(layout, packed).value();
    const Vec3 n = normalize(Vec3{1, 2, 3});
    EXPECT_EQ(irradiance(codec.evaluator(), sampler, {0.3f, 0.9f}, n), codec.irradiance(c, n));
}

TEST(BasesAsValues, HaveTheNamesThatMakeThem) {
    const std::vector<std::shared_ptr<const Basis>> made = {
        spherical_harmonics(2),
        spherical_gaussians(12),
        spherical_gaussians(9, {.domain = Domain::hemisphere}),
        spherical_gaussians(5, {.sharpness = 2.5f}),
        spherical_gaussians(6, {.ambient = GaussianOptions::Ambient::one}),
        fitted_gaussians(4),
        octahedral_texels(8),
        hemisphere_polynomials(6),
        zh3(),
        zh3(ZonalAxis::per_channel),
        ambient_cube(),
        ambient_dice(),
        ambient_highlight()};
    for (const auto& basis : made) {
        const auto named = make_basis(basis->name());
        ASSERT_TRUE(named) << basis->name();
        EXPECT_EQ((*named)->name(), basis->name());
        EXPECT_EQ((*named)->size(), basis->size()) << basis->name();
        EXPECT_EQ((*named)->domain(), basis->domain()) << basis->name();
        EXPECT_FALSE(card_of(*basis).family.empty()) << basis->name();
    }
}

}  // namespace
}  // namespace lobelia
