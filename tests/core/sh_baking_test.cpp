// Tests that the steps of the degree-1 SH bake give the irradiance of the SH basis, and that the stored form equals
// that of a ratio storage.
#include "core/basis/sh/sh_baking.h"

#include "lobelia/codec.h"
#include "lobelia/storage.h"
#include "support.h"

namespace lobelia {
namespace {

using namespace sh_baking;

constexpr std::array k_domains = {Domain::sphere, Domain::hemisphere};

/// A dim, coloured surround and a bright spot.
Samples some_samples(Domain domain, std::size_t count = 2000) {
    const Vec3 bright = normalize(Vec3{0.4f, -0.5f, 0.7f});
    return test::samples_of(domain, count, [&](Vec3 d) {
        const float spot = std::exp(20 * (dot(d, bright) - 1));
        return Rgb{0.2f + 0.1f * d.x + 5 * spot, 0.3f + 4 * spot, 0.25f + 0.2f * d.z + 3 * spot};
    });
}

std::vector<Vec3> some_normals(Domain domain) {
    const Directions directions = test::random_directions(domain, 50, 4);
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < directions.size(); ++i) normals.push_back(direction_at(directions, i));
    return normals;
}

void expect_equal(Rgb a, Rgb b) {
    const auto tolerance = static_cast<float>(2e-6 * std::max(1.0, test::norm(b)));
    EXPECT_NEAR(a.r, b.r, tolerance);
    EXPECT_NEAR(a.g, b.g, tolerance);
    EXPECT_NEAR(a.b, b.b, tolerance);
}

TEST(ShBaking, AllFormsAreEqual) {
    for (const Domain domain : k_domains) {
        const Samples samples = some_samples(domain);
        const Degree1 by_convolution = convolved(projection(samples, domain));
        const Degree1 by_merging = merged(samples, domain);
        const Degree1 plain = means(samples);
        const Stored kept = stored(plain);
        for (const Vec3 n : some_normals(domain)) {
            const Rgb E = irradiance_of_convolved(by_convolution, n);
            expect_equal(irradiance_of_merged(by_merging, n), E);
            expect_equal(irradiance_over_pi_of_means(plain, n, domain) * static_cast<float>(k_pi), E);
            expect_equal(irradiance_over_pi_of_stored(kept, n, domain) * static_cast<float>(k_pi), E);
            expect_equal(irradiance_over_pi_of_means(means_of_stored(kept), n, domain) * static_cast<float>(k_pi), E);
        }
    }
}

TEST(ShBaking, ItIsTheBasisOfDegreeOne) {
    const Samples samples = some_samples(Domain::sphere);
    const Codec codec = make_codec("sh1/moments/convolution-signed").value();
    const auto c = codec.encode(samples);
    const auto expected = coefficients_of_means(means(samples), Domain::sphere);
    ASSERT_EQ(c.size(), expected.size());
    for (std::size_t i = 0; i < c.size(); ++i) EXPECT_LE(test::norm(c[i] - expected[i]), 1e-5 * test::norm(c));
    const Directions normals = test::random_directions(Domain::sphere, 50, 5);
    Colours E(normals.size());
    codec.irradiance(c, normals, E);
    const Degree1 sums = merged(samples, Domain::sphere);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Rgb found = irradiance_of_merged(sums, direction_at(normals, i)), reference = colour_at(E.view(), i);
        EXPECT_LE(test::norm(found - reference), 2e-5 * test::norm(reference));
    }
}

TEST(ShBaking, ConstantAndLinearSkiesAreExact) {
    // L = 1 + a . d gives E / pi = 1 + 2/3 a . n over the sphere.
    const Vec3 a{0.3f, -0.2f, 0.5f};
    const Samples samples = test::samples_of(Domain::sphere, 1 << 14, [&](Vec3 d) { return Rgb{1, 1 + dot(a, d), 2}; });
    const Stored kept = stored(means(samples));
    for (const Vec3 n : some_normals(Domain::sphere)) {
        const Rgb found = irradiance_over_pi_of_stored(kept, n, Domain::sphere);
        EXPECT_NEAR(found.r, 1, 1e-3);
        EXPECT_NEAR(found.g, 1 + 2.0f / 3 * dot(a, n), 1e-3);
        EXPECT_NEAR(found.b, 2, 2e-3);
    }
    // A white hemisphere, seen along its normal: degree 1 gives 1/2 + 1/2.
    const Samples half = test::samples_of(Domain::hemisphere, 1 << 14, [](Vec3) { return Rgb{1, 1, 1}; });
    EXPECT_NEAR(irradiance_over_pi_of_means(means(half), {0, 0, 1}, Domain::hemisphere).g, 1, 1e-3);
}

TEST(ShBaking, RatiosAreWithinZeroAndOne) {
    // The extreme case is a single light, |L1| = L0; on an axis it reaches the ends of the range.
    for (const Vec3 d : {Vec3{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6f, 0, -0.8f}}) {
        Samples one(1);
        one.set(0, {d, {3, 0.001f, 0}, 1});
        const Stored kept = stored(means(one));
        const float components[3] = {d.x, d.y, d.z};
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_FLOAT_EQ(kept.L1[i].r, 0.5f + 0.5f * components[i]);
            EXPECT_FLOAT_EQ(kept.L1[i].g, 0.5f + 0.5f * components[i]);
            EXPECT_EQ(kept.L1[i].b, 0.5f);  // black has no direction
        }
    }
    for (const Domain domain : k_domains)
        for (const Rgb L1 : stored(means(some_samples(domain))).L1)
            for (const float v : {L1.r, L1.g, L1.b}) EXPECT_TRUE(v >= 0 && v <= 1);
}

TEST(ShBaking, CoefficientsRoundTrip) {
    for (const Domain domain : k_domains) {
        const Degree1 plain = means(some_samples(domain));
        const Degree1 back = means_of_coefficients(coefficients_of_means(plain, domain), domain);
        expect_equal(back.constant, plain.constant);
        for (std::size_t i = 0; i < 3; ++i) expect_equal(back.along[i], plain.along[i]);
        // Projection finds the same coefficients.
        const Degree1 c = projection(some_samples(domain), domain);
        expect_equal(coefficients_of_means(plain, domain)[0], c.constant);
        expect_equal(coefficients_of_means(plain, domain)[3], c.along[0]);
    }
}

TEST(ShBaking, StoredRatiosAreThoseOfTheStorage) {
    const auto encoder = make_encoder("moments", make_basis("sh1").value()).value();
    const auto traits = coefficient_traits(*encoder);
    const TextureLayout layout = find_storage("ratio8").value()->layout(traits);
    const Degree1 plain = means(some_samples(Domain::sphere));
    const auto c = coefficients_of_means(plain, Domain::sphere);
    const Stored kept = stored(plain);
    const std::array<std::size_t, 4> axis = {0, 1, 2, 0};  // coefficients 1, 2, 3 are those of y, z, x
    for (const auto& texture : layout.textures)
        for (const StoredChannel& channel : texture.channels) {
            if (channel.form != StoredChannel::Form::ratio || channel.component != Component::g) continue;
            const float ratio = c[channel.coefficient].g / c[0].g;
            EXPECT_NEAR(channel.scale * ratio + channel.offset, kept.L1[axis[channel.coefficient]].g, 1e-6);
        }
}

/// Samples a texel as a shader does: all channels of a texture.
std::array<float, 4> texel_of(const PackedTexture& texture, std::size_t i) {
    std::array<std::vector<float>, 4> channels;
    std::vector<float*> pointers;
    for (std::size_t k = 0; k < info(texture.format).channels; ++k) {
        channels[k].resize(texture.width * texture.height);
        pointers.push_back(channels[k].data());
    }
    decode_texels(texture.format, texture.width, texture.height, texture.data, pointers);
    std::array<float, 4> texel{};
    for (std::size_t k = 0; k < pointers.size(); ++k) texel[k] = texture.scale * channels[k][i];
    return texel;
}

TEST(ShBaking, ShadersReadTheIrradianceFromTheStorageOfRatios) {
    // Wide light, narrow light, and the extreme case: all light from one direction.
    const auto basis = make_basis("sh1").value();
    const auto encoder = make_encoder("moments", basis).value();
    Samples one(1);
    one.set(0, {normalize(Vec3{1, 2, -3}), {3, 1, 0}, 1});
    for (const Samples& light : {some_samples(Domain::sphere), one}) {
        Accumulator accumulator(encoder);
        accumulator.add(light);
        const std::vector<Rgb> c = accumulator.solve();
        std::vector<std::vector<float>> values;
        for (const Rgb& v : c)
            for (const float channel : {v.r, v.g, v.b}) values.push_back({channel});
        const TextureLayout layout = find_storage("ratio8").value()->layout(coefficient_traits(*encoder));
        const auto textures =
            pack(layout, CoefficientPlanes(1, 1, std::span<const std::vector<float>>(values), c.size()));
        ASSERT_EQ(textures.size(), 4u);

        // The lines of docs/bake-format.md.
        const auto c0 = texel_of(textures[0], 0), t0 = texel_of(textures[1], 0), t1 = texel_of(textures[2], 0),
                   t2 = texel_of(textures[3], 0);
        const auto l = [](float stored) { return 2 * stored - 1; };
        const Rgb y{l(t0[0]), l(t0[1]), l(t0[2])}, z{l(t0[3]), l(t1[0]), l(t1[1])}, x{l(t1[2]), l(t1[3]), l(t2[0])};
        const auto evaluator = basis->evaluator("convolution-signed");
        const Directions normals = test::random_directions(Domain::sphere, 200, 2);
        Colours expected(normals.size());
        irradiance(*evaluator, c, normals, expected);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const Vec3 n = direction_at(normals, i);
            for (std::size_t k = 0; k < 3; ++k) {
                const float L0 = 0.28209479f * c0[k];
                const auto of = [&](const Rgb& colour) { return (&colour.r)[k]; };
                const float E = 2 * static_cast<float>(k_pi) * L0 * (0.5f + of(x) * n.x + of(y) * n.y + of(z) * n.z);
                // Allow nine bits of L0, and half a step of each component of L1.
                const float brightest = 0.28209479f * std::max({c0[0], c0[1], c0[2]});
                const float allowed =
                    2 * static_cast<float>(k_pi) * (1.5f * 0x1p-9f * brightest + L0 * std::sqrt(3.0f) / 255);
                EXPECT_NEAR(E, expected.channel(k)[i], 1.01f * allowed + 1e-6f);
            }
        }
    }
}

TEST(ShBaking, RatiosOfTheStorageAreL1WithoutRounding) {
    // E = 2 pi L0 (1/2 + L1.n), with L1 = 2 t - 1 from the layout's own scales and offsets.
    const auto basis = make_basis("sh1").value();
    const auto encoder = make_encoder("moments", basis).value();
    Accumulator accumulator(encoder);
    accumulator.add(some_samples(Domain::sphere));
    const std::vector<Rgb> c = accumulator.solve();
    Vec3 L1{};
    for (const auto& texture : find_storage("ratio8").value()->layout(coefficient_traits(*encoder)).textures)
        for (const StoredChannel& channel : texture.channels) {
            if (channel.form != StoredChannel::Form::ratio || channel.component != Component::r) continue;
            const float t = channel.scale * c[channel.coefficient].r / c[0].r + channel.offset;
            (channel.coefficient == 1 ? L1.y : channel.coefficient == 2 ? L1.z : L1.x) = 2 * t - 1;
        }
    const Directions normals = test::random_directions(Domain::sphere, 200, 3);
    Colours expected(normals.size());
    irradiance(*basis->evaluator("convolution-signed"), c, normals, expected);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const float L0 = 0.28209479f * c[0].r;
        const float E = 2 * static_cast<float>(k_pi) * L0 * (0.5f + dot(L1, direction_at(normals, i)));
        EXPECT_NEAR(E, expected.channel(0)[i], 3e-6f * 2 * static_cast<float>(k_pi) * L0);
    }
}

}  // namespace
}  // namespace lobelia
