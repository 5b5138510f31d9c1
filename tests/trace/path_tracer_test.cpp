// Tests light transport against known answers: furnaces, analytic scenes, switches that must not change the mean,
// repeatability. Monte Carlo tests have fixed seeds; each states its limit in standard errors.
#include "trace/path_tracer.h"

#include <gtest/gtest.h>

#include "core/sample/sequence.h"
#include "measure.h"
#include "support.h"

namespace lobelia {
namespace {

using test::expect_near;
using test::measure;

/// A closed box of side 2 about the origin that emits 1 and reflects `rho`, moved by a transform.
Scene furnace(float rho, const Transform& world_from_box = {}) {
    Scene scene;
    scene.materials = {test::matte({rho, rho, rho}, {1, 1, 1})};
    Mesh box;
    test::add_box(box, 0, {-1, -1, -1}, {1, 1, 1}, test::Facing::inwards);
    test::add_object(scene, box, world_from_box);
    return scene;
}

TEST(PathTracer, WhiteFurnace) {
    // Le / (1 - rho) everywhere, within 3 standard errors; later bounces contribute a millionth at most.
    for (const float rho : {0.2f, 0.5f, 0.8f})
        for (const Switch roulette : {Switch::on, Switch::off})
            for (const Switch next_event : {Switch::on, Switch::off}) {
                const Scene scene = furnace(rho);
                const World world = make_world(scene);
                PathOptions options;
                options.bounces = rho > 0.5f ? 60 : 25;
                options.roulette = roulette;
                options.next_event = next_event;
                const PathTracer tracer(scene, world, options);
                for (const Vec3 p : {Vec3{0.1f, -1, 0.3f}, {-0.9f, -1, 0.95f}, {0.999f, -1, 0.999f}, {0, -1, -0.5f}}) {
                    const auto found = measure(tracer, p, {0, 1, 0}, {.keys = 32, .samples = 64});
                    expect_near(found.channels[0], k_pi / (1 - static_cast<double>(rho)), 3);
                    EXPECT_EQ(found.back_faces, 0u);
                }
            }
}

TEST(PathTracer, FurnaceOfEveryTwoSidedAndSmoothSurface) {
    // A smooth sphere and double-sided sheets in the box emit and reflect like its walls: the radiance stays the same.
    Scene scene = furnace(0.5f);
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].double_sided = true;
    test::add_object(scene, test::make_sphere(0, 3, test::Normals::smooth), test::scaled(0.3f, {0.3f, 0.1f, 0}));
    Mesh sheet;
    test::add_square(sheet, 1, {-0.5f, 0, 0}, {0, 1, 0}, normalize(Vec3{0.2f, 0, 1}), 0.4f);
    test::add_object(scene, sheet);
    const World world = make_world(scene);
    const PathTracer tracer(scene, world, {.bounces = 40});
    for (const Vec3 p : {Vec3{0.3f, -1, 0.1f}, {-0.5f, -1, 0}}) {
        // Directions under a facet that the smooth normal allows are lost: with 512 facets less than half a per cent.
        const auto found = measure(tracer, p, {0, 1, 0}).channels[0];
        EXPECT_NEAR(found.mean(), 2 * k_pi, 3 * found.standard_error() + 0.005 * 2 * k_pi);
    }
}

TEST(PathTracer, FurnaceAtAnyScaleAndPlace) {
    for (const float scale : {0.005f, 1.0f, 5000.0f})
        for (const float distance : {0.0f, 10.0f}) {
            const Rotation turn = test::some_rotation();
            const Vec3 centre = Vec3{0.7f, -0.4f, 0.6f} * (distance * scale);
            const Scene scene = furnace(0.5f, {{turn[0] * scale, turn[1] * scale, turn[2] * scale}, centre});
            const World world = make_world(scene);
            const PathTracer tracer(scene, world, {.bounces = 40});
            for (const Vec3 local : {Vec3{0.2f, -1, 0.3f}, Vec3{-0.98f, -1, 0.97f}}) {
                const auto found = measure(tracer, rotate(turn, local) * scale + centre, rotate(turn, {0, 1, 0}));
                // 3 standard errors, plus the thousandth that corners lose because rays start off the surface, far from
                // the origin.
                EXPECT_NEAR(found.channels[0].mean(), 2 * k_pi,
                            3 * found.channels[0].standard_error() + 1e-3 * 2 * k_pi)
                    << scale << ' ' << distance;
                EXPECT_EQ(found.back_faces, 0u) << scale << ' ' << distance;
            }
        }
}

TEST(PathTracer, NoRayLeavesAClosedScene) {
    // A fine sphere from within, far from the origin: no ray slips between triangles.
    Scene scene;
    scene.materials = {test::matte({1, 1, 1})};
    scene.materials[0].double_sided = true;
    test::add_object(scene, test::make_sphere(0, 5, test::Normals::smooth), test::scaled(3, {40, -70, 30}));
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    std::vector<PathTracer::Ray> rays;
    const Directions directions = uniform_directions(Domain::sphere, Sequence::sobol, 20000, 1);
    for (std::size_t i = 0; i < directions.size(); ++i)
        rays.push_back({Vec3{40.5f, -69, 29}, direction_at(directions, i), INFINITY});
    const std::size_t random = rays.size();
    // Aim at the middles of edges, then at vertices.
    for (const auto& t : world.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            rays.push_back(
                {rays[0].origin,
                 normalize((world.positions[t[k]] + world.positions[t[(k + 1) % 3]]) * 0.5f - rays[0].origin),
                 INFINITY});
    const std::size_t vertices = rays.size();
    for (const Vec3 p : world.positions) rays.push_back({rays[0].origin, normalize(p - rays[0].origin), INFINITY});
    std::vector<PathTracer::Hit> hits(rays.size());
    tracer.closest(rays, hits);
    std::array<std::size_t, 3> misses{};
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!(hits[i].distance < 10) || !hits[i].back_face) ++misses[i < random ? 0 : i < vertices ? 1 : 2];
    }
    EXPECT_EQ(misses[0], 0u);
    EXPECT_EQ(misses[1], 0u);
    // Embree misses one in hundreds of rays that aim exactly at a vertex; random rays never do.
    EXPECT_LT(misses[2], world.positions.size() / 100);
}

/// A floor at y = 0 with reflectance `rho`, by default so large that it counts as infinite.
Scene plane_scene(float rho, float half = 1e4f) {
    Scene scene;
    scene.materials = {test::matte({rho, rho, rho})};
    Mesh floor;
    test::add_square(floor, 0, {}, {0, 0, 1}, {1, 0, 0}, half);
    test::add_object(scene, floor);
    return scene;
}

TEST(PathTracer, PlaneUnderConstantSky) {
    Scene scene = plane_scene(0.6f);
    scene.environment = test::constant_sky({1, 2, 3});
    const World world = make_world(scene);
    for (const Switch table : {Switch::on, Switch::off}) {
        const PathTracer tracer(scene, world, {.environment_table = table});
        const auto up = measure(tracer, {0.3f, 0, 0.1f}, {0, 1, 0});
        for (std::size_t k = 0; k < 3; ++k) expect_near(up.channels[k], (static_cast<double>(k) + 1) * k_pi, 4);
        // At a wall: half sky, half floor; the floor reflects rho times the sky.
        const auto wall = measure(tracer, {0, 1, 0}, {1, 0, 0});
        for (std::size_t k = 0; k < 3; ++k)
            expect_near(wall.channels[k], (static_cast<double>(k) + 1) * k_pi * (0.5 + 0.5 * 0.6), 4);
        // At a probe, over all directions: the same mean, times pi.
        const auto probe = measure(tracer, {0, 1, 0}, {0, 1, 0}, {.domain = Domain::sphere});
        for (std::size_t k = 0; k < 3; ++k)
            expect_near(probe.channels[k], (static_cast<double>(k) + 1) * k_pi * (0.5 + 0.5 * 0.6), 4);
    }
}

TEST(PathTracer, SphereLightOverPlane) {
    // E = pi L (r / d)^2 cos: a sphere wholly above the horizon. A convex polyhedron's shadow has on average a quarter
    // of its surface (Cauchy), which gives its radius.
    Scene scene = plane_scene(0);
    scene.materials.push_back(test::matte({}, {10, 5, 1}));
    const Vec3 centre{0.2f, 2, -0.4f};
    test::add_object(scene, test::make_sphere(1, 4, test::Normals::flat), test::scaled(0.3f, centre));
    const World world = make_world(scene);
    double surface = 0;
    for (std::size_t t = world.first_triangle[1]; t < world.first_triangle[2]; ++t) {
        const auto& [a, b, c] = world.triangles[t];
        surface += 0.5 * static_cast<double>(length(
                             cross(world.positions[b] - world.positions[a], world.positions[c] - world.positions[a])));
    }
    const double radius2 = surface / (4 * k_pi);
    for (const Switch next_event : {Switch::on, Switch::off}) {
        const PathTracer tracer(scene, world, {.next_event = next_event});
        for (const Vec3 p : {Vec3{0.2f, 0, -0.4f}, {3, 0, 1}, {-1, 0, -8}}) {
            const Vec3 to = centre - p;
            const double d2 = dot(to, to), cosine = to.y / std::sqrt(d2);
            const auto found = measure(tracer, p, {0, 1, 0}, {.keys = 64, .samples = 512});
            for (std::size_t k = 0; k < 3; ++k) {
                const double truth = std::array{10, 5, 1}[k] * k_pi * radius2 / d2 * cosine;
                EXPECT_NEAR(found.channels[k].mean(), truth, 4 * found.channels[k].standard_error() + 1e-3 * truth);
                // Shadow rays find it at once.
                if (next_event == Switch::on) {
                    EXPECT_LT(found.channels[k].standard_error(), 3e-3 * truth);
                }
            }
        }
    }
}

TEST(PathTracer, DirectionalLightGivesItsIrradiance) {
    for (const float radius : {0.0f, 0.005f, 0.2f})
        for (const Switch sun_size : {Switch::on, Switch::off}) {
            Scene scene = plane_scene(0.5f);
            PunctualLight sun;
            sun.kind = PunctualLight::Kind::directional;
            sun.direction = normalize(Vec3{1, -2, 0.5f});
            sun.intensity = {3, 2, 1};
            sun.angular_radius = radius;
            scene.lights = {sun};
            const World world = make_world(scene);
            const PathTracer tracer(scene, world, {.sun_size = sun_size});
            const auto found = measure(tracer, {}, {0, 1, 0});
            for (std::size_t k = 0; k < 3; ++k)
                expect_near(found.channels[k], static_cast<double>(-sun.direction.y) * (3.0 - static_cast<double>(k)),
                            4);
        }
}

TEST(PathTracer, PointAndSpotLightsFollowTheInverseSquare) {
    Scene scene = plane_scene(0, 10);
    PunctualLight light;
    light.position = {0, 2, 0};
    light.intensity = {4, 8, 12};
    const auto found_at = [&](Vec3 p) {
        scene.lights = {light};
        const World world = make_world(scene);
        const PathTracer tracer(scene, world);
        return measure(tracer, p, {0, 1, 0}, {.keys = 2, .samples = 16}).channels[0];
    };
    for (const float x : {0.0f, 1.0f, 5.0f}) {
        const double d2 = x * x + 4, expected = 4 * 2 / std::pow(d2, 1.5);
        light.kind = PunctualLight::Kind::point;
        light.range = 0;
        expect_near(found_at({x, 0, 0}), expected, 3);
        light.range = 4;
        expect_near(found_at({x, 0, 0}), expected * std::max(0.0, 1 - std::pow(d2 / 16, 2)), 3);

        light.kind = PunctualLight::Kind::spot;
        light.range = 0;
        light.direction = {0, -1, 0};
        light.inner_angle = 0.3f;
        light.outer_angle = 0.8f;
        const double t = (2 / std::sqrt(d2) - std::cos(0.8)) / (std::cos(0.3) - std::cos(0.8));
        expect_near(found_at({x, 0, 0}), expected * std::pow(std::clamp(t, 0.0, 1.0), 2), 3);

        // Equal angles, the default of three.js: all of the light up to the edge, none beyond.
        light.inner_angle = light.outer_angle = 0.5f;
        expect_near(found_at({x, 0, 0}), x < 2 * std::tan(0.5) ? expected : 0, 3);
    }
    EXPECT_GT(found_at({1.09f, 0, 0}).mean(), 0);
    EXPECT_EQ(found_at({1.095f, 0, 0}).mean(), 0);
}

/// Irradiance at p with normal (0, 1, 0) from a square light of half width h at height d above p, which emits radiance
/// 1 downwards: four times Lambert's formula for a quarter.
double square_light(double h, double d) {
    const double r = std::hypot(h, d);
    return 4 * 0.5 * 2 * (h / r) * std::atan(h / r);
}

TEST(PathTracer, SquareLightOfAnySizeIsExact) {
    // Tiny lights need shadow rays, huge ones are better hit by chance; MIS weights keep the error small for both.
    for (const float half : {0.001f, 0.1f, 1.0f, 10.0f, 100.0f})
        for (const auto choice : {DirectionChoice::uniform, DirectionChoice::mixture}) {
            Scene scene = plane_scene(0, 10);
            scene.materials.push_back(test::matte({}, {1, 1, 1}));
            Mesh lamp;
            test::add_square(lamp, 1, {0, 2, 0}, {1, 0, 0}, {0, 0, 1}, half);
            test::add_object(scene, lamp);
            const World world = make_world(scene);
            const PathTracer tracer(scene, world);
            const auto found = measure(tracer, {}, {0, 1, 0}, {.directions = choice}).channels[0];
            const double truth = square_light(static_cast<double>(half), 2);
            expect_near(found, truth, 4, std::to_string(half));
            EXPECT_LT(found.standard_error(), 0.02 * truth) << half;
        }
}

/// A room with every extended light: a lamp, a window to an uneven sky with a broad sun; with glossy and transparent
/// surfaces.
Scene room() {
    Scene scene;
    scene.materials = {test::matte({0.7f, 0.6f, 0.5f}), test::matte({0.5f, 0.5f, 0.5f}, {4, 3, 2}), Material{},
                       Material{}};
    scene.materials[2].base_color = {0.9f, 0.6f, 0.3f};
    scene.materials[2].metallic = 0.8f;
    scene.materials[2].roughness = 0.4f;
    scene.materials[2].double_sided = true;
    scene.materials[3].alpha = 0.4f;
    scene.materials[3].alpha_mode = Material::Alpha::blend;
    scene.materials[3].double_sided = true;
    Mesh mesh;
    test::add_box(mesh, 0, {-1, -1, -1}, {1, 1, 1}, test::Facing::inwards);
    // Leave the wall at x = 1 open.
    mesh.triangles.resize(mesh.triangles.size() - 2);
    mesh.materials.resize(mesh.triangles.size());
    test::add_square(mesh, 1, {0, 0.99f, 0}, {1, 0, 0}, {0, 0, 1}, 0.2f);
    test::add_square(mesh, 2, {-0.4f, -0.3f, -0.2f}, normalize(Vec3{1, 1, 0}), {0, 0, 1}, 0.4f);
    test::add_square(mesh, 3, {0.9f, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0.6f);
    test::add_object(scene, mesh);
    Image sky = test::constant_sky({0.3f, 0.5f, 1});
    for (std::size_t x = 0; x < sky.width; ++x) sky.at(x, 3) = {0.1f, 0.1f, 0};
    scene.environment = sky;
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::directional;
    sun.direction = normalize(Vec3{-1, -0.7f, 0.2f});
    sun.intensity = {3, 3, 2};
    sun.angular_radius = 0.15f;
    scene.lights = {sun};
    return scene;
}

TEST(PathTracer, SwitchesAgreeInTheMean) {
    const Scene scene = room();
    const World world = make_world(scene);
    const PathOptions defaults{.bounces = 5};
    std::vector<PathOptions> others(4, defaults);
    others[0].next_event = Switch::off;
    others[1].environment_table = Switch::off;
    others[2].roulette = Switch::off;
    others[3].seed = 77;
    for (const Vec3 p : {Vec3{0.2f, -1, 0.3f}, Vec3{-0.7f, -1, -0.5f}}) {
        const PathTracer tracer(scene, world, defaults);
        const auto expected = measure(tracer, p, {0, 1, 0}, {.samples = 512});
        for (std::size_t i = 0; i < others.size(); ++i)
            for (const auto choice : {DirectionChoice::uniform, DirectionChoice::mixture}) {
                const PathTracer other(scene, world, others[i]);
                const auto found = measure(other, p, {0, 1, 0}, {.directions = choice, .samples = 512});
                // 48 comparisons with a significance of 1e-3 for all together: 4.3 standard errors.
                for (std::size_t k = 0; k < 3; ++k)
                    EXPECT_LT(deviation(found.channels[k], expected.channels[k]), 4.3) << i << ' ' << k;
            }
    }
}

TEST(PathTracer, BouncesAreSurfacesBetweenSourceAndOrigin) {
    // In the furnace each further bounce adds rho^n.
    const Scene scene = furnace(0.5f);
    const World world = make_world(scene);
    double expected = 0;
    for (int bounces = 0; bounces < 5; ++bounces) {
        expected += k_pi * std::pow(0.5, bounces);
        const PathTracer tracer(scene, world, {.bounces = bounces});
        expect_near(measure(tracer, {0.1f, -1, 0.2f}, {0, 1, 0}).channels[0], expected, 4);
    }
}

TEST(PathTracer, SameBitsWhateverTheBatch) {
    const Scene scene = room();
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    std::vector<PathStart> starts;
    std::vector<Vec3> normals;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const Pair p = pair(i, 0, 0, 1);
        starts.push_back({{0.5f * p.a, -0.9f, 0.5f * p.b},
                          UniformHemisphere::sample({static_cast<double>(p.b), static_cast<double>(p.a)}),
                          i % 7,
                          i / 7});
        normals.push_back({0, 0, 1});
    }
    const auto all = [&](std::size_t batch) {
        std::vector<Incident> incident(starts.size());
        std::vector<DirectLight> direct(starts.size());
        const auto scratch = tracer.make_scratch();
        for (std::size_t first = 0; first < starts.size(); first += batch) {
            const std::size_t count = std::min(batch, starts.size() - first);
            tracer.trace(std::span(starts).subspan(first, count), std::span(normals).subspan(first, count),
                         std::span(incident).subspan(first, count), *scratch);
            tracer.direct(std::span(starts).subspan(first, count), std::span(normals).subspan(first, count),
                          std::span(direct).subspan(first, count), *scratch);
        }
        return std::tuple{incident, direct, PathTracer::rays(*scratch)};
    };
    const auto [incident, direct, rays] = all(starts.size());
    for (const std::size_t batch : {1u, 7u, 1024u, 1500u}) {
        const auto [other_incident, other_direct, other_rays] = all(batch);
        EXPECT_EQ(rays, other_rays);
        for (std::size_t i = 0; i < starts.size(); ++i) {
            ASSERT_EQ(incident[i].scattered, other_incident[i].scattered);
            ASSERT_EQ(incident[i].emitted, other_incident[i].emitted);
            ASSERT_EQ(incident[i].source_pdf, other_incident[i].source_pdf);
            ASSERT_EQ(incident[i].distance, other_incident[i].distance);
            ASSERT_EQ(direct[i].irradiance, other_direct[i].irradiance);
            ASSERT_EQ(direct[i].direction, other_direct[i].direction);
        }
    }
}

/// A sheet at y = 1 over the floor, with a point light at y = 2 and a sky: measures how much light it transmits.
Scene sheet_scene(const Material& material, Vec3 x, Vec3 y) {
    Scene scene = plane_scene(0, 100);
    scene.materials.push_back(material);
    Mesh sheet;
    test::add_square(sheet, 1, {0, 1, 0}, x, y, 100);
    test::add_object(scene, sheet);
    PunctualLight light;
    light.position = {0.3f, 2, 0.1f};  // off the diagonal, where a ray would meet both triangles

    light.intensity = {4, 4, 4};
    scene.lights = {light};
    scene.environment = test::constant_sky({0.5f, 0.5f, 0.5f});
    return scene;
}

/// Irradiance with the sheet over irradiance without it, for a source sampled by shadow rays and for one hit by chance.
double transmitted(const Scene& scene, Switch next_event) {
    const World world = make_world(scene);
    const PathTracer tracer(scene, world, {.next_event = next_event});
    const auto found = measure(tracer, {}, {0, 1, 0}, {.samples = 1024}).channels[0];
    const double point = 4 * 2 / std::pow(4.1, 1.5), sky = 0.5 * k_pi;
    return found.mean() / (next_event == Switch::on ? point + sky : sky);
}

TEST(PathTracer, TransparencyLetsItsShareThrough) {
    Material veil = test::matte({});
    veil.double_sided = true;
    for (const Switch next_event : {Switch::on, Switch::off}) {
        veil.alpha_mode = Material::Alpha::blend;
        veil.alpha = 0.3f;
        EXPECT_NEAR(transmitted(sheet_scene(veil, {1, 0, 0}, {0, 0, 1}), next_event), 0.7, 0.01);
        veil.alpha_mode = Material::Alpha::mask;
        EXPECT_NEAR(transmitted(sheet_scene(veil, {1, 0, 0}, {0, 0, 1}), next_event), 1, 0.01);
        veil.alpha = 0.6f;
        EXPECT_LT(transmitted(sheet_scene(veil, {1, 0, 0}, {0, 0, 1}), next_event), 1e-4);
        veil.alpha_mode = Material::Alpha::opaque;
        veil.alpha = 0.1f;
        EXPECT_LT(transmitted(sheet_scene(veil, {1, 0, 0}, {0, 0, 1}), next_event), 1e-4);
    }
}

TEST(PathTracer, OneSidedSurfacesStopLightFromTheFrontOnly) {
    // Reflected light of the point light on the floor, seen from between floor and sheet.
    const auto radiance = [&](Vec3 x, Vec3 y) {
        Scene scene = sheet_scene(test::matte({}), x, y);
        scene.materials[0] = test::matte({1, 1, 1});
        scene.environment.reset();
        const World world = make_world(scene);
        const PathTracer tracer(scene, world, {.bounces = 1});
        const auto scratch = tracer.make_scratch();
        const PathStart start{{0, 0.5f, 0}, {0, -1, 0}, 0, 0};
        Incident in;
        tracer.trace({&start, 1}, {&in, 1}, *scratch);
        return static_cast<double>(in.scattered.g);
    };
    // The shadow ray comes from below and hits the front of a sheet that faces down.
    EXPECT_EQ(radiance({1, 0, 0}, {0, 0, 1}), 0);
    EXPECT_NEAR(radiance({0, 0, 1}, {1, 0, 0}), 4 * 2 / std::pow(4.1, 1.5) / k_pi, 1e-4);
}

TEST(PathTracer, CoincidentOneSidedSurfacesAreASolidSheet) {
    // Leaves are often modelled as two faces back to back in one place. They must neither leak nor show a back face.
    Scene scene = furnace(0.5f);
    Mesh leaf;
    test::add_square(leaf, 0, {0, -0.5f, 0}, normalize(Vec3{1, 0.2f, 0}), {0, 0, 1}, 0.5f);
    test::add_square(leaf, 0, {0, -0.5f, 0}, {0, 0, 1}, normalize(Vec3{1, 0.2f, 0}), 0.5f);
    test::add_object(scene, leaf);
    const World world = make_world(scene);
    const PathTracer tracer(scene, world, {.bounces = 40});
    for (const float y : {-1.0f, 0.5f}) {
        const auto found = measure(tracer, {0.1f, y, 0.1f}, {0, y < 0 ? 1.0f : -1.0f, 0});
        expect_near(found.channels[0], 2 * k_pi, 3.5);
        EXPECT_EQ(found.back_faces, 0u);
    }
}

TEST(PathTracer, NoLightReachesReceiversPastBacks) {
    for (const Switch next_event : {Switch::on, Switch::off}) {
        const Scene scene = sheet_scene(test::matte({}), {0, 0, 1}, {1, 0, 0});
        EXPECT_LT(transmitted(scene, next_event), 1e-4);
    }
}

TEST(PathTracer, BackFacesAreReported) {
    Scene scene;
    scene.materials = {test::matte({0.5f, 0.5f, 0.5f})};
    Mesh box;
    test::add_box(box, 0, {-1, -1, -1}, {1, 1, 1}, test::Facing::outwards);
    test::add_object(scene, box);
    scene.environment = test::constant_sky({1, 1, 1});
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    const auto scratch = tracer.make_scratch();
    const PathStart start{{}, {0, 1, 0}, 0, 0};
    Incident in;
    tracer.trace({&start, 1}, {&in, 1}, *scratch);
    EXPECT_TRUE(in.back_face);
    EXPECT_NEAR(in.distance, 1, 1e-6);

    scene.materials[0].double_sided = true;
    const PathTracer solid(scene, world);
    solid.trace({&start, 1}, {&in, 1}, *scratch);
    EXPECT_FALSE(in.back_face);
}

TEST(PathTracer, UnlitSurfacesAreBlack) {
    Scene scene = furnace(0.5f);
    scene.materials[0].unlit = true;
    scene.environment = test::constant_sky({1, 1, 1});
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    EXPECT_EQ(measure(tracer, {0, -1, 0}, {0, 1, 0}).channels[0].mean(), 0);
}

TEST(PathTracer, EmptyScenesAreDark) {
    const Scene nothing;
    const World world = make_world(nothing);
    const PathTracer tracer(nothing, world);
    EXPECT_FALSE(tracer.has_light());
    EXPECT_EQ(measure(tracer, {}, {0, 1, 0}).channels[0].mean(), 0);
    Scene black;
    black.environment = test::constant_sky({});
    const PathTracer dark(black, world);
    EXPECT_FALSE(dark.has_light());
}

TEST(PathTracer, TrianglesWithoutAreaDoNoHarm) {
    Scene scene = furnace(0.5f);
    Mesh line;
    test::add_triangle(line, 0, {0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0});
    test::add_triangle(line, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    test::add_object(scene, line);
    const World world = make_world(scene);
    const PathTracer tracer(scene, world, {.bounces = 40});
    expect_near(measure(tracer, {0.1f, -1, 0.1f}, {0, 1, 0}).channels[0], 2 * k_pi, 3.5);
}

}  // namespace
}  // namespace lobelia
