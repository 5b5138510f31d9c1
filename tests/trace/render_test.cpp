// Tests camera pictures: exact where the light is known, and the same bits at any number of threads.
#include "bake/render/render.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/quadrature.h"
#include "lobelia/sampling.h"
#include "scene/embedded.h"
#include "scenes.h"
#include "trace/camera_view.h"

namespace lobelia {
namespace {

constexpr Rgb k_albedo{0.7f, 0.5f, 0.25f}, k_emission{0.5f, 1, 2};

/// A cube of side 2 about the origin, seen from within: six inward squares, each with a sixth of the UV square.
Scene closed_box(const Material& material) {
    std::vector<Mesh> meshes;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const auto along = [&](int a) { return Vec3{a == 0 ? 1.0f : 0, a == 1 ? 1.0f : 0, a == 2 ? 1.0f : 0}; };
            const Vec3 u = along((axis + 1) % 3) * (2 * -side), v = along((axis + 2) % 3) * 2;
            const Vec3 corner = along(axis) * side + (u + v) * -0.5f;
            const auto n = static_cast<float>(meshes.size());
            meshes.push_back(test::parallelogram(corner, u, v, {n / 6, 0}, {(n + 1) / 6, 1}));
        }
    Scene scene = test::scene_of(std::move(meshes));
    scene.materials[0] = material;
    return scene;
}

Material glowing(bool specular) {
    Material material;
    material.base_color = k_albedo;
    material.emission = k_emission;
    material.specular = specular ? 1.0f : 0.0f;
    material.roughness = 0.4f;
    return material;
}

/// Radiance of the furnace: Le / (1 - albedo).
Rgb furnace_radiance() {
    return {k_emission.r / (1 - k_albedo.r), k_emission.g / (1 - k_albedo.g), k_emission.b / (1 - k_albedo.b)};
}

void expect_near(Rgb a, Rgb b, float tolerance) {
    const auto most = [tolerance](float x) { return tolerance * std::max(1.0f, std::abs(x)); };
    EXPECT_NEAR(a.r, b.r, most(b.r));
    EXPECT_NEAR(a.g, b.g, most(b.g));
    EXPECT_NEAR(a.b, b.b, most(b.b));
}

/// A page whose every texel holds the same radiance from everywhere.
struct ConstantBake {
    std::optional<Codec> codec;
    std::vector<LightmapPage> pages;
    std::vector<AtlasPlacement> placements;
    PageChannels channels;

    ConstantBake(const Scene& scene, const std::string& codec_name, Rgb radiance) {
        if (!codec_name.empty()) codec = *make_codec(codec_name);
        std::vector<Rgb> c;
        if (codec) {
            // Exact for light that all bases here represent.
            const SphereRule rule = product_rule(codec->basis().domain(), 24);
            Samples samples(rule.weights.size());
            for (std::size_t i = 0; i < samples.size(); ++i)
                samples.set(i,
                            {direction_at(rule.directions.view(), i), radiance, static_cast<float>(rule.weights[i])});
            c = codec->encode(samples);
        }
        channels.coefficients = c.size();
        LightmapPage page(12, 4, channels.count());
        const auto fill = [&](std::size_t plane, Rgb value) {
            page.planes[plane].assign(page.size(), value.r);
            page.planes[plane + 1].assign(page.size(), value.g);
            page.planes[plane + 2].assign(page.size(), value.b);
        };
        for (std::size_t i = 0; i < c.size(); ++i) fill(channels.coefficient(i, 0), c[i]);
        fill(channels.irradiance(0), radiance * static_cast<float>(k_pi));
        pages.push_back(std::move(page));
        for (std::size_t i = 0; i < scene.objects.size(); ++i) placements.push_back({0, {12, 4}, {0, 0}, {}, true});
    }
    [[nodiscard]] BakedLight light(bool in_tangent_frame) const {
        return {pages, placements, channels, codec, in_tangent_frame ? Frame::tangent : Frame::world};
    }
};

Camera within() {
    Camera camera;
    camera.world_from_camera.translation = {0.2f, -0.1f, 0.3f};
    camera.vertical_field_of_view = 1.4f;
    return camera;
}

RenderOptions small() {
    RenderOptions options;
    options.width = 37;
    options.height = 22;
    options.samples = 7;
    options.threads = 2;
    return options;
}

Image paths(const Scene& scene, const PathOptions& path_options, const RenderOptions& options) {
    const World world = make_world(scene);
    const PathTracer tracer(scene, world, path_options);
    return *render_paths(tracer, scene.cameras.empty() ? within() : scene.cameras.front(), options);
}

TEST(RenderBake, WhiteFurnaceOfDiffuseWalls) {
    const Scene scene = closed_box(glowing(false));
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    // SH represent a constant exactly in every frame; without a codec the picture uses the irradiance of the paths.
    for (const char* codec : {"sh1/moments/convolution", "sh2/projection/convolution", ""})
        for (const bool tangent : {false, true}) {
            const ConstantBake bake(scene, codec, furnace_radiance());
            const Image image = *render_bake(tracer, bake.light(tangent), within(), small());
            for (const Rgb& pixel : image.pixels) expect_near(pixel, furnace_radiance(), 2e-5f);
        }
}

TEST(RenderBake, HemisphericalLobesGiveTheFurnaceWithinTheirFit) {
    const Scene scene = closed_box(glowing(false));
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    const ConstantBake bake(scene, "sg12h/least-squares/exact", furnace_radiance());
    const Image image = *render_bake(tracer, bake.light(true), within(), small());
    for (const Rgb& pixel : image.pixels) expect_near(pixel, furnace_radiance(), 0.03f);
}

TEST(RenderBake, GlossyWallsReflectWhatTheyScatter) {
    // In constant radiance L from all directions, the reflected light equals the reflectance of the tracer's surfaces
    // times L.
    const Scene scene = closed_box(glowing(true));
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    const ConstantBake bake(scene, "sh1/moments/convolution", {1, 1, 1});
    RenderOptions options = small();
    options.width = options.height = 1;
    options.samples = 16384;
    const Rgb seen = render_bake(tracer, bake.light(false), within(), options)->pixels[0];

    const CameraRays rays(within(), 1, 1, tracer.options().seed);
    const CameraView view(tracer, std::vector<std::uint8_t>(6, 1));
    double sum = 0, squares = 0;
    for (std::uint32_t s = 0; s < options.samples; ++s) {
        const PathStart ray = rays.ray(0, s);
        Sight sight;
        view.resolve({&ray, 1}, {&sight, 1});
        ASSERT_EQ(sight.kind, Sight::Kind::baked);
        const SurfacePoint at = view.surfaces().point(sight.hit.triangle, sight.hit.u, sight.hit.v, ray.direction);
        const Vec3 wo{std::sqrt(std::max(0.0f, 1 - std::pow(dot(at.normal, ray.direction), 2.0f))), 0,
                      -dot(at.normal, ray.direction)};
        const Scattered scattered = scatter(at.reflectance, wo, pair(5, s, 0, 1), pair(5, s, 1, 1).a);
        const double value = scattered.pdf > 0 ? static_cast<double>(scattered.weight.g) : 0;
        sum += value;
        squares += value * value;
    }
    const double mean = sum / options.samples;
    const double error = std::sqrt((squares / options.samples - mean * mean) / options.samples);
    // Five standard errors of independent samples; a sequence has less error.
    EXPECT_NEAR(seen.g - k_emission.g, mean, 5 * error);
}

TEST(RenderBake, ReadsTheTexelsAboutThePoint) {
    // Bilinear interpolation reproduces irradiance that grows linearly over a square.
    Scene scene = test::scene_of({test::parallelogram({-1, -1, -1}, {2, 0, 0}, {0, 2, 0})});
    scene.materials[0].specular = 0;
    ConstantBake bake(scene, "", {0, 0, 0});
    bake.placements[0].scale = {8, 4};
    bake.placements[0].offset = {2, 0};
    for (std::size_t i = 0; i < bake.pages[0].size(); ++i)
        bake.pages[0].planes[bake.channels.irradiance(1)][i] = static_cast<float>(k_pi) * static_cast<float>(i % 12);
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    Camera camera;
    camera.vertical_field_of_view = static_cast<float>(k_pi / 2);
    RenderOptions options;
    options.width = options.height = 8;
    options.samples = 64;
    const Image image = *render_bake(tracer, bake.light(false), camera, options);
    for (std::size_t y = 1; y < 7; ++y)
        for (std::size_t x = 0; x < 8; ++x)
            EXPECT_NEAR(image.at(x, y).g, static_cast<float>(x + 2), 0.03f) << x << ' ' << y;
}

TEST(RenderBake, TracesWhatThePagesDoNotHold) {
    const Scene scene = cornell_scene();
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    ConstantBake bake(scene, "", {0, 0, 0});
    for (AtlasPlacement& placement : bake.placements) placement.baked = false;
    const Image by_bake = *render_bake(tracer, bake.light(false), scene.cameras.front(), small());
    EXPECT_EQ(by_bake.pixels, render_paths(tracer, scene.cameras.front(), small())->pixels);
}

TEST(RenderPaths, WhiteFurnace) {
    PathOptions options;
    options.bounces = 64;
    const Image image = paths(closed_box(glowing(false)), options, small());
    // Few samples are noisy; their mean over the picture is not.
    double mean = 0;
    for (const Rgb& pixel : image.pixels)
        mean += static_cast<double>(pixel.r) / static_cast<double>(image.pixels.size());
    EXPECT_NEAR(mean, furnace_radiance().r, 0.02 * furnace_radiance().r);
}

TEST(RenderPaths, PixelIsTheMeanOfItsPaths) {
    const Scene scene = cornell_scene();
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    const Camera& camera = scene.cameras.front();
    const RenderOptions options = small();
    const Image image = *render_paths(tracer, camera, options);
    const CameraRays rays(camera, options.width, options.height, tracer.options().seed);
    const auto scratch = tracer.make_scratch();
    for (const std::size_t pixel : {0u, 123u, 400u, 813u}) {
        double r = 0;
        for (std::uint32_t s = 0; s < options.samples; ++s) {
            const PathStart start = rays.ray(pixel, s);
            Incident in;
            tracer.trace({&start, 1}, {&in, 1}, *scratch);
            r += static_cast<double>((in.emitted + in.scattered).r);
        }
        EXPECT_EQ(image.pixels[pixel].r, static_cast<float>(r / options.samples));
    }
}

TEST(RenderPaths, UnlitSurfacesShowTheirColour) {
    Material unlit;
    unlit.unlit = true;
    unlit.base_color = {0.25f, 0.5f, 1};
    for (const Rgb& pixel : paths(closed_box(unlit), {}, small()).pixels) expect_near(pixel, unlit.base_color, 1e-6f);
}

TEST(RenderPaths, UnlitSurfacesBlend) {
    Material unlit;
    unlit.unlit = true;
    unlit.alpha = 0.25f;
    unlit.alpha_mode = Material::Alpha::blend;
    Scene scene = test::scene_of({test::parallelogram({-9, -9, -1}, {18, 0, 0}, {0, 18, 0})});
    scene.materials[0] = unlit;
    RenderOptions options = small();
    options.samples = 64;
    double mean = 0;
    const Image image = paths(scene, {}, options);
    for (const Rgb& pixel : image.pixels)
        mean += static_cast<double>(pixel.r) / static_cast<double>(image.pixels.size());
    // A share of 1 in front of black; 52,096 independent choices, five standard errors.
    EXPECT_NEAR(mean, 0.25, 5 * std::sqrt(0.25 * 0.75 / 52096));
}

TEST(RenderPaths, UnlitSurfacesShowBehindWhatBlends) {
    Scene scene = test::scene_of({test::parallelogram({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}),
                                  test::parallelogram({-9, -9, -2}, {18, 0, 0}, {0, 18, 0})});
    scene.materials.resize(2);
    scene.materials[0].alpha = 0.25f;
    scene.materials[0].alpha_mode = Material::Alpha::blend;
    scene.materials[1].unlit = true;
    scene.meshes[1].materials.assign(2, 1);
    RenderOptions options = small();
    options.samples = 64;
    double mean = 0;
    const Image image = paths(scene, {}, options);
    for (const Rgb& pixel : image.pixels)
        mean += static_cast<double>(pixel.r) / static_cast<double>(image.pixels.size());
    // Three quarters of white behind black; five standard errors of as many choices.
    EXPECT_NEAR(mean, 0.75, 5 * std::sqrt(0.25 * 0.75 / 52096));
}

TEST(Render, SameBitsAtAnyNumberOfThreads) {
    const Scene scene = cornell_scene();
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    const ConstantBake bake(scene, "sh1/moments/convolution", {1, 2, 3});
    RenderOptions one = small(), three = small();
    one.threads = 1;
    three.threads = 3;
    const Camera& camera = scene.cameras.front();
    EXPECT_EQ(render_paths(tracer, camera, one)->pixels, render_paths(tracer, camera, three)->pixels);
    EXPECT_EQ(render_bake(tracer, bake.light(false), camera, one)->pixels,
              render_bake(tracer, bake.light(false), camera, three)->pixels);
}

TEST(Render, StopsAndTellsItsProgress) {
    const Scene scene = cornell_scene();
    const World world = make_world(scene);
    const PathTracer tracer(scene, world);
    std::vector<double> told;
    RenderOptions options = small();
    options.progress = [&](double done) { told.push_back(done); };
    ASSERT_TRUE(render_paths(tracer, scene.cameras.front(), options));
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), 1.0);
    const std::atomic<bool> stop = true;
    options.stop = &stop;
    EXPECT_FALSE(render_paths(tracer, scene.cameras.front(), options));
}

}  // namespace
}  // namespace lobelia
