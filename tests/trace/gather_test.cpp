// Tests gathering: samples agree with the irradiance beside them, layouts are as documented, and no bit depends on how
// the work is divided.
#include "bake/gather/gather.h"

#include <gtest/gtest.h>

#include "bake/place/texels.h"
#include "core/sample/sequence.h"
#include "measure.h"
#include "support.h"

namespace lobelia {
namespace {

/// A floor, a lamp over it, a step beside, a sky and a sun.
Scene yard() {
    Scene scene;
    scene.materials = {test::matte({0.6f, 0.5f, 0.4f}), test::matte({0.1f, 0.1f, 0.1f}, {5, 4, 3})};
    Mesh mesh;
    test::add_square(mesh, 0, {}, {0, 0, 1}, {1, 0, 0}, 5);
    test::add_square(mesh, 1, {0, 2, 0}, {1, 0, 0}, {0, 0, 1}, 0.3f);
    test::add_box(mesh, 0, {0.5f, 0, -1}, {2, 0.7f, 1}, test::Facing::outwards);
    test::add_object(scene, mesh);
    scene.environment = test::constant_sky({0.3f, 0.4f, 0.5f});
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::directional;
    sun.direction = normalize(Vec3{1, -1, 0});
    sun.intensity = {1, 1, 1};
    scene.lights = {sun};
    return scene;
}

class Gathering : public ::testing::Test {
  protected:
    Receiver receiver(Domain domain, std::uint32_t key) const {
        Receiver r;
        std::copy(positions_.begin(), positions_.end(), r.positions.begin());
        r.position_count = 2;
        r.normal = normalize(Vec3{0.1f, 1, 0.2f});
        r.domain = domain;
        r.key = key;
        return r;
    }
    void run(std::span<const Receiver> receivers, SampleRange range, const GatherOptions& options = {}) {
        gather(tracer_, receivers, range, options, buffer_, *scratch_);
    }

    Scene scene_ = yard();
    World world_ = make_world(scene_);
    PathTracer tracer_{scene_, world_};
    std::array<Vec3, 2> positions_{Vec3{0.1f, 0.01f, 0.1f}, {-0.2f, 0.01f, 0.3f}};
    decltype(tracer_.make_scratch()) scratch_ = tracer_.make_scratch();
    GatherBuffer buffer_;
};

/// Sum of radiance times solid angle times cosine over one receiver's samples, as an encoder would weigh them.
Rgb summed(SampleView samples, Vec3 normal, Domain domain) {
    Rgb sum;
    for (std::size_t i = 0; i < samples.size; ++i) {
        const Vec3 d = direction_at(samples.directions(), i);
        const float cosine = domain == Domain::sphere ? 0.25f : std::max(0.0f, dot(d, normal));
        sum = sum + colour_at(samples.radiance(), i) * (cosine * samples.solid_angles()[i]);
    }
    return sum;
}

TEST_F(Gathering, SamplesCarryTheIrradiance) {
    for (const Domain domain : {Domain::hemisphere, Domain::sphere})
        for (const auto choice : {DirectionChoice::uniform, DirectionChoice::mixture}) {
            if (domain == Domain::sphere && choice == DirectionChoice::mixture) continue;
            const Receiver r = receiver(domain, 5);
            run({&r, 1}, {32, 64}, {choice});
            const Rgb sum =
                summed(buffer_.directions(0), r.normal, domain) + summed(buffer_.sources(0), r.normal, domain);
            const float unit = static_cast<float>(solid_angle(domain)) / 64;
            const Rgb e = buffer_.gathered(0).irradiance;
            EXPECT_NEAR(sum.r * unit, e.r, 1e-4 * e.r);
            EXPECT_NEAR(sum.b * unit, e.b, 1e-4 * e.b);
        }
}

TEST_F(Gathering, SolidAnglesAreOneInTheMean) {
    const Receiver r = receiver(Domain::hemisphere, 5);
    run({&r, 1}, {0, 64});
    for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(buffer_.directions(0).solid_angles()[i], 1, 1e-6);
    EXPECT_EQ(buffer_.sources(0).solid_angles()[3], k_splat_share);
    run({&r, 1}, {0, 4096}, {DirectionChoice::mixture});
    double sum = 0;
    for (std::size_t i = 0; i < 4096; ++i) sum += static_cast<double>(buffer_.directions(0).solid_angles()[i]);
    EXPECT_NEAR(sum / 4096, 1, 0.01);
}

TEST_F(Gathering, DarkBelowAddsTheOtherHalfOfTheSphere) {
    const Receiver r = receiver(Domain::hemisphere, 5);
    run({&r, 1}, {0, 16}, {DirectionChoice::uniform, Switch::on});
    const SampleView samples = buffer_.directions(0);
    ASSERT_EQ(samples.size, 32u);
    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_GE(dot(direction_at(samples.directions(), i), r.normal), -1e-6f);
        EXPECT_LE(dot(direction_at(samples.directions(), 16 + i), r.normal), 1e-6f);
        EXPECT_EQ(colour_at(samples.radiance(), 16 + i), Rgb{});
        EXPECT_EQ(samples.solid_angles()[16 + i], 1);
    }
}

TEST_F(Gathering, SameBitsHoweverItIsDivided) {
    std::vector<Receiver> receivers;
    for (std::uint32_t key = 0; key < 40; ++key)
        receivers.push_back(receiver(key % 3 == 0 ? Domain::sphere : Domain::hemisphere, key));
    run(receivers, {0, 64});
    std::vector<std::vector<RadianceSample>> whole(receivers.size());
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const SampleView paths = buffer_.directions(r), lights = buffer_.sources(r);
        for (const SampleView& part : {paths, lights})
            for (std::size_t i = 0; i < part.size; ++i)
                whole[r].push_back({direction_at(part.directions(), i), colour_at(part.radiance(), i), 0});
    }
    for (std::size_t r = 0; r < receivers.size(); ++r)
        for (const std::uint32_t first : {0u, 32u}) {
            run({&receivers[r], 1}, {first, 32});
            const SampleView paths = buffer_.directions(0), lights = buffer_.sources(0);
            for (std::size_t i = 0; i < 32; ++i) {
                ASSERT_EQ(direction_at(paths.directions(), i), whole[r][first + i].direction);
                ASSERT_EQ(colour_at(paths.radiance(), i), whole[r][first + i].radiance);
                ASSERT_EQ(colour_at(lights.radiance(), i), whole[r][64 + first + i].radiance);
            }
        }
}

TEST_F(Gathering, TheFrameTurnsDirectionsAlone) {
    const Receiver r = receiver(Domain::hemisphere, 9);
    run({&r, 1}, {0, 32});
    std::vector<RadianceSample> before;
    for (std::size_t i = 0; i < 32; ++i)
        before.push_back(
            {direction_at(buffer_.directions(0).directions(), i), colour_at(buffer_.directions(0).radiance(), i), 0});
    run({&r, 1}, {0, 32}, {.frame = Frame::tangent});
    for (std::size_t i = 0; i < 32; ++i) {
        EXPECT_EQ(colour_at(buffer_.directions(0).radiance(), i), before[i].radiance);
        EXPECT_LT(length(direction_at(buffer_.directions(0).directions(), i) -
                         rotate(tangent_from_world(r.normal), before[i].direction)),
                  1e-6f);
    }
}

TEST_F(Gathering, SamplesTakeTurnsBetweenPositions) {
    // One position receives the lamp's light, the other lies inside a block.
    const std::array<Vec3, 2> places{Vec3{0.1f, 0.01f, 0.1f}, {1, 0.3f, 0}};
    Receiver r = receiver(Domain::hemisphere, 1);
    std::copy(places.begin(), places.end(), r.positions.begin());
    r.normal = {0, 1, 0};
    run({&r, 1}, {0, 64});
    EXPECT_EQ(buffer_.gathered(0).back_faces, 32u);
    for (std::size_t i = 1; i < 64; i += 2) EXPECT_EQ(colour_at(buffer_.directions(0).radiance(), i), Rgb{});
}

TEST_F(Gathering, AimingMakesLightSourcesQuiet) {
    // The standard error with shadow rays is far below that without them.
    scene_.environment.reset();
    scene_.lights.clear();
    const PathTracer aiming(scene_, world_, {.bounces = 0}),
        blind(scene_, world_, {.bounces = 0, .next_event = Switch::off});
    const auto quiet = test::measure(aiming, {-0.3f, 0, 0}, {0, 1, 0}).channels[0],
               loud = test::measure(blind, {-0.3f, 0, 0}, {0, 1, 0}).channels[0];
    EXPECT_LT(deviation(quiet, loud), 4);
    EXPECT_LT(quiet.standard_error(), 0.1 * loud.standard_error());
}

TEST_F(Gathering, ANoneLightSceneGivesNothing) {
    scene_ = {};
    world_ = make_world(scene_);
    const PathTracer dark(scene_, world_);
    const Receiver r = receiver(Domain::hemisphere, 1);
    gather(dark, {&r, 1}, {0, 16}, {}, buffer_, *scratch_);
    EXPECT_EQ(buffer_.gathered(0).irradiance, Rgb{});
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(colour_at(buffer_.sources(0).radiance(), i), Rgb{});
}

}  // namespace
}  // namespace lobelia
