// The steps of the degree-1 SH bake give the same irradiance, that of the SH basis, and what is stored is what a
// storage of ratios stores.
#include "lobelia/bases/sh_baking.h"

#include "lobelia/codec.h"
#include "lobelia/pack.h"
#include "support.h"

namespace lobelia {
namespace {

using namespace sh_baking;

constexpr std::array k_domains = {Domain::sphere, Domain::hemisphere};

/// Light of every kind: a dim, coloured surround and a bright spot.
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
    // A white hemisphere, seen along its normal: degree 1 says 1/2 + 1/2 of it.
    const Samples half = test::samples_of(Domain::hemisphere, 1 << 14, [](Vec3) { return Rgb{1, 1, 1}; });
    EXPECT_NEAR(irradiance_over_pi_of_means(means(half), {0, 0, 1}, Domain::hemisphere).g, 1, 1e-3);
}

TEST(ShBaking, RatiosAreWithinZeroAndOne) {
    // The extreme is a single light, |L1| = L0: at the ends of the range where it lies on an axis.
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

}  // namespace
}  // namespace lobelia
