// A landscape of a million triangles under the sky: for measuring the cost of large scenes.
#include <cmath>

#include "scene/embedded.h"
#include "scene/scene_builder.h"
#include "scene/sky_light.h"

namespace lobelia {
namespace {

/// Height and its slopes: a sum of waves of decreasing length, each rotated against the one before and half as high.
struct Height {
    float y = 0, dx = 0, dz = 0;
};
Height height_at(float x, float z, float side) {
    Height h;
    float length = 0.5f * side, amplitude = 0.06f * side, turn = 0.4f;
    for (int octave = 0; octave < 8; ++octave) {
        const float k = 2 * static_cast<float>(k_pi) / length, c = std::cos(turn), s = std::sin(turn);
        const float phase = k * (c * x + s * z), wave = amplitude * std::sin(phase),
                    slope = amplitude * k * std::cos(phase);
        h.y += wave;
        h.dx += slope * c;
        h.dz += slope * s;
        length *= 0.55f;
        amplitude *= 0.45f;
        turn += 1.9f;
    }
    return h;
}

}  // namespace

Scene terrain_scene(const TerrainOptions& options) {
    SceneBuilder builder("terrain");
    Material ground;
    ground.name = "ground";
    ground.base_color = {0.45f, 0.4f, 0.3f};
    PatchOptions patch;
    patch.columns = patch.rows = options.quads;
    patch.size = {options.side, options.side};
    patch.material = builder.material(ground);
    builder.begin_object("terrain");
    builder.patch(patch, [&](float u, float v) {
        const float x = (u - 0.5f) * options.side, z = (0.5f - v) * options.side;
        const Height h = height_at(x, z, options.side);
        return PatchPoint{{x, h.y, z}, normalize({-h.dx, 1, -h.dz}), {u, v}};
    });
    Scene scene = builder.finish({});
    set_sky(scene, {});

    Camera camera;
    camera.name = "hill";
    const Vec3 eye{0, height_at(0, 0.45f * options.side, options.side).y + 0.12f * options.side, 0.45f * options.side};
    camera.world_from_camera.translation = eye;
    const float tilt = -0.25f, c = std::cos(tilt), s = std::sin(tilt);
    camera.world_from_camera.rows = {Vec3{1, 0, 0}, {0, c, -s}, {0, s, c}};
    scene.cameras.push_back(camera);
    return scene;
}

}  // namespace lobelia
