// Tests light sources: samples agree with pdfs and inverses, and every source can be chosen.
#include "trace/light/light.h"

#include <gtest/gtest.h>

#include "core/sample/directions.h"
#include "scene/light/light_kind.h"
#include "small_scenes.h"
#include "support.h"

namespace lobelia {
namespace {

Image uneven_sky() {
    Image image(32, 16);
    std::mt19937 generator(3);
    for (Rgb& c : image.pixels) {
        const float v = unit_float(static_cast<std::uint32_t>(generator()));
        c = {v * v, v, generator() % 4 == 0 ? 0 : v};
    }
    image.at(5, 3) = {200, 150, 100};
    for (std::size_t x = 0; x < 32; ++x) image.at(x, 11) = {};
    return image;
}

TEST(EnvironmentTable, SampleToInverseRoundTrip) {
    const Image image = uneven_sky();
    for (const auto choice : {EnvironmentLight::Choice::by_brightness, EnvironmentLight::Choice::uniform}) {
        const EnvironmentLight light(image, choice);
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const EnvironmentSample s = light.sample(pair(1, i, 0, 1));
            EXPECT_NEAR(length(s.direction), 1, 1e-6);
            EXPECT_GT(s.pdf, 0);
            // An alias table maps several numbers to one direction: the direction comes back, the number need not.
            const EnvironmentSample again = light.sample(light.inverse(s.direction));
            EXPECT_LT(length(again.direction - s.direction), 2e-3);
        }
    }
}

TEST(EnvironmentTable, SampleAgreesWithPdfAndRadiance) {
    const Image image = uneven_sky();
    const EnvironmentLight light(image, EnvironmentLight::Choice::by_brightness);
    std::size_t agree = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const EnvironmentSample s = light.sample(pair(1, i, 0, 1)), looked_up = light.at(s.direction);
        agree += s.pdf == looked_up.pdf && s.radiance == looked_up.radiance ? 1 : 0;
    }
    // All except directions that rounding moves into the next texel.
    EXPECT_GT(agree, 4080);
}

TEST(EnvironmentTable, SamplesFollowPdf) {
    const Image image = uneven_sky();
    const LatLong grid = lat_long(image);
    for (const auto choice : {EnvironmentLight::Choice::by_brightness, EnvironmentLight::Choice::uniform}) {
        const EnvironmentLight light(image, choice);
        constexpr std::uint32_t count = 200000;
        std::vector<double> hits(grid.size());
        std::mt19937 generator(4);
        const auto random = [&] { return unit_float(static_cast<std::uint32_t>(generator())); };
        for (std::uint32_t i = 0; i < count; ++i) {
            const Pair point{random(), random()};
            ++hits[grid.index(light.sample(point).direction)];
        }
        double chi_square = 0, total = 0;
        std::size_t cells = 0;
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const double expected =
                count * grid.solid_angle(i / grid.width) * static_cast<double>(light.pdf(grid.direction(i)));
            total += expected;
            EXPECT_TRUE(expected > 0 || hits[i] == 0);
            if (expected < 5) continue;
            chi_square += (hits[i] - expected) * (hits[i] - expected) / expected;
            ++cells;
        }
        EXPECT_NEAR(total, count, 1e-3 * count);
        EXPECT_LT(chi_square, test::chi_square_limit(cells - 1));
    }
}

/// Lights of every kind about the origin: a hundred emissive triangles, some double-sided, points, suns, a sky.
Scene many_lights() {
    Scene scene;
    scene.materials = {test::matte({}, {3, 2, 1}), test::matte({}, {1, 1, 9})};
    scene.materials[1].double_sided = true;
    std::mt19937 generator(8);
    const auto random = [&] { return 2 * unit_float(static_cast<std::uint32_t>(generator())) - 1; };
    Mesh mesh;
    for (std::uint32_t i = 0; i < 100; ++i) {
        const Vec3 a{4 * random(), 4 * random(), 4 * random()};
        const Vec3 b{random(), random(), random()}, c{random(), random(), random()};
        test::add_triangle(mesh, i % 2, a, a + b, a + c);
    }
    test::add_object(scene, mesh);
    for (int i = 0; i < 20; ++i) {
        PunctualLight light;
        light.kind = i < 15 ? PunctualLight::Kind::point : PunctualLight::Kind::directional;
        light.intensity = {1, 2, 3};
        light.position = {3 * random(), 3 * random(), 3 * random()};
        light.direction = normalize(Vec3{random(), random(), random()});
        light.angular_radius = i % 2 == 0 ? 0.1f : 0.0f;
        scene.lights.push_back(light);
    }
    scene.environment = test::constant_sky({0.1f, 0.1f, 0.1f});
    return scene;
}

TEST(EveryLightKind, ReachesPointsWithItsProfile) {
    for (const auto kind : light_kinds()) {
        SCOPED_TRACE(light_kind(kind).name);
        Scene scene;
        const PunctualLight light = test::some_light(kind);
        scene.lights = {light};
        const World world = make_world(scene);
        const Surfaces surfaces(scene, world);
        const Lights lights(scene, surfaces, {});
        for (const Vec3 to : {light.direction * -2.0f, Vec3{0.5f, 1, 0}, Vec3{3, 1, 0}, Vec3{0, -1, 0.5f}}) {
            const bool near = light_kind(kind).place == LightPlace::near;
            const LightSample s = lights.sample({light.position - to, {}}, 0.5f, {0.5f, 0.5f});
            const Vec3 towards = near ? normalize(to) : light.direction * -1.0f;
            const auto profile = light_kind(kind).profile;
            const float fraction = profile != nullptr ? profile(light, -dot(towards, light.direction)) : 1;
            const float expected = light.intensity.g * fraction / (near ? dot(to, to) : 1);
            EXPECT_NEAR(s.irradiance.g, expected, 1e-5f * expected + 1e-9f);
            if (expected > 0) {
                EXPECT_NEAR(dot(s.direction, towards), 1, 1e-6f);
            }
        }
    }
}

class ManyLights : public ::testing::Test {
  protected:
    Scene scene_ = many_lights();
    World world_ = make_world(scene_);
    Surfaces surfaces_{scene_, world_};
    Lights lights_{scene_, surfaces_, {}};
};

TEST_F(ManyLights, SampledTrianglesHaveTheDensityThatIsStated) {
    const RayScene rays(world_, surfaces_.kinds(), surfaces_);
    std::size_t compared = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const Vantage at{{0.1f, 0.2f, 0.3f}, i % 2 == 0 ? Vec3{} : normalize(Vec3{1, 2, -1})};
        const LightSample s = lights_.sample(at, pair(1, i, 0, 1).a, pair(1, i, 1, 1));
        if (s.pdf == 0 || !(s.distance < INFINITY)) continue;
        const RayHit hit = rays.closest_stop(at.position, s.direction, 0, Backs::pass);
        // Skip points occluded by another triangle: their ray cannot find them.
        if (std::abs(hit.distance - s.distance) > 1e-4f) continue;
        const Facet& facet = surfaces_.facet(hit.triangle);
        const float pdf =
            lights_.triangle_pdf(at, facet.emitter, hit.distance, std::abs(dot(facet.normal, s.direction)));
        EXPECT_NEAR(pdf, s.pdf, 1e-3 * s.pdf);
        ++compared;
    }
    EXPECT_GT(compared, 500u);
}

TEST_F(ManyLights, SampledSkyHasTheDensityThatIsStated) {
    std::size_t compared = 0;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const Vantage at{{0.1f, 0.2f, 0.3f}, i % 2 == 0 ? Vec3{} : normalize(Vec3{1, 2, -1})};
        const LightSample s = lights_.sample(at, pair(1, i, 0, 1).a, pair(1, i, 1, 1));
        if (s.pdf == 0 || s.distance < INFINITY) continue;
        const SkyLight sky = lights_.sky(at, s.direction);
        EXPECT_NEAR(sky.pdf, s.pdf, 1e-3 * s.pdf);
        EXPECT_NEAR(sky.radiance.g / sky.pdf, s.irradiance.g, 1e-3 * s.irradiance.g);
        ++compared;
    }
    EXPECT_GT(compared, 500u);
}

/// Irradiance at a shading point without occlusion, summed over the sources one by one.
double unshadowed(const Scene& scene, const World& world, Vec3 at, Vec3 normal) {
    double sum = k_pi * 0.1;  // the sky
    for (const PunctualLight& light : scene.lights) {
        if (light.kind == PunctualLight::Kind::directional) {
            // The mean cosine over a disc above the horizon equals the cosine to its centre.
            sum += static_cast<double>(light.intensity.g) * std::max(0.0f, -dot(light.direction, normal));
        } else {
            const Vec3 to = light.position - at;
            sum += static_cast<double>(light.intensity.g * std::max(0.0f, dot(normalize(to), normal)) / dot(to, to));
        }
    }
    // Integrate triangles over a fine grid of centroids.
    constexpr int n = 64;
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        const auto& [i, j, k] = world.triangles[t];
        const Vec3 a = world.positions[i], e = world.positions[j] - a, f = world.positions[k] - a;
        const Vec3 area = cross(e, f) * (0.5f / (n * n));
        const Material& m = scene.materials[world.material[t]];
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const bool upper = x + y >= n;
                const float third = upper ? 2.0f / 3 : 1.0f / 3;
                float u = (static_cast<float>(x) + third) / n, v = (static_cast<float>(y) + third) / n;
                if (upper) u = 1 - u, v = 1 - v, std::swap(u, v);
                if (u + v > 1) continue;
                const Vec3 to = a + e * u + f * v - at;
                const float d2 = dot(to, to), cosine = std::max(0.0f, dot(to, normal)) / std::sqrt(d2);
                const float projected = -dot(to, area) / std::sqrt(d2);
                if (projected < 0 && !m.double_sided) continue;
                sum += static_cast<double>(m.emission.g * cosine * std::abs(projected) / d2);
            }
    }
    return sum;
}

TEST_F(ManyLights, MeanOfSamplesIsTheSumOverSources) {
    for (const Vec3 at : {Vec3{0.1f, 0.2f, 0.3f}, Vec3{8, -3, 1}, Vec3{-20, 5, 9}})
        for (const Vec3 normal : {normalize(Vec3{1, 2, -1}), Vec3{0, 0, 1}}) {
            test::Estimate estimate;
            for (std::uint32_t key = 0; key < 64; ++key) {
                double sum = 0;
                for (std::uint32_t i = 0; i < 1024; ++i) {
                    const LightSample s = lights_.sample({at, normal}, pair(key, i, 0, 1).a, pair(key, i, 1, 1));
                    sum += static_cast<double>(s.irradiance.g * std::max(0.0f, dot(s.direction, normal))) / 1024;
                }
                estimate.add(sum);
            }
            const double expected = unshadowed(scene_, world_, at, normal);
            // 3.9 standard errors: 1e-4, and the grid's own error.
            EXPECT_NEAR(estimate.mean(), expected, 3.9 * estimate.standard_error() + 5e-3 * expected);
            EXPECT_LT(estimate.standard_error(), 0.05 * expected);
        }
}

TEST(AliasTables, OneNumberChoosesAndIsUniformAfterwards) {
    const std::vector<float> weights{1, 0, 3, 2, 0.5f};
    const AliasTable table(weights);
    constexpr int count = 100000, cells = 8;
    std::vector<double> hits(weights.size() * cells);
    for (int i = 0; i < count; ++i) {
        const auto [index, rest] = table.sample((i + 0.5) / count);
        ASSERT_TRUE(rest >= 0 && rest < 1);
        ++hits[index * cells + static_cast<std::size_t>(rest * cells)];
        if (i % 100 == 0 && table.probability(index) > 0) {
            const auto again = table.sample(table.inverse({index, rest}));
            EXPECT_EQ(again.index, index);
            EXPECT_NEAR(again.rest, rest, 1e-6);
        }
    }
    for (std::size_t i = 0; i < weights.size(); ++i)
        for (std::size_t c = 0; c < cells; ++c)
            EXPECT_NEAR(hits[i * cells + c], count * static_cast<double>(weights[i]) / 6.5 / cells, 12)
                << i << ' ' << c;
}

}  // namespace
}  // namespace lobelia
