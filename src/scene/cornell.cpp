// The Cornell box. Goral et al. 1984; sizes and positions after the data of the Cornell University Program of Computer
// Graphics.
#include "scene/embedded.h"
#include "scene/scene_builder.h"

namespace lobelia {
namespace {

constexpr float k_half_width = 2.75f, k_height = 5.5f, k_half_depth = 2.8f;

Material diffuse(const char* name, Rgb color) {
    Material material;
    material.name = name;
    material.base_color = color;
    material.specular = 0;  // the original's paint is matt
    return material;
}

/// Adds a block on the floor, rotated by `angle` [radians], without its bottom.
void add_block(SceneBuilder& builder, Vec3 base_centre, Vec3 size, double angle, std::uint32_t material) {
    BoxOptions options;
    options.faces = k_face_sides | k_face_top;
    options.material = material;
    options.world_from_box = {rotation_about({0, 1, 0}, angle), base_centre};
    builder.box({-0.5f * size.x, 0, -0.5f * size.z}, {0.5f * size.x, size.y, 0.5f * size.z}, options);
}

/// Adds the walls, each an object that faces inwards.
void add_walls(SceneBuilder& builder, const CornellOptions& options) {
    const auto white = builder.material(diffuse("white", {0.725f, 0.71f, 0.68f}));
    const auto red = builder.material(diffuse("red", {0.63f, 0.065f, 0.05f}));
    const auto green = builder.material(diffuse("green", {0.14f, 0.45f, 0.091f}));
    constexpr float w = k_half_width, h = k_height, d = k_half_depth;
    const auto wall = [&](const char* name, Vec3 corner, Vec3 right, Vec3 up, std::uint32_t material) {
        builder.begin_object(name);
        PatchOptions patch;
        patch.material = material;
        builder.quad(corner, right, up, patch);
    };
    wall("floor", {-w, 0, d}, {2 * w, 0, 0}, {0, 0, -2 * d}, white);
    wall("ceiling", {-w, h, -d}, {2 * w, 0, 0}, {0, 0, 2 * d}, white);
    wall("back wall", {-w, 0, -d}, {2 * w, 0, 0}, {0, h, 0}, white);
    wall("left wall", {-w, 0, d}, {0, 0, -2 * d}, {0, h, 0}, red);
    wall("right wall", {w, 0, -d}, {0, 0, 2 * d}, {0, h, 0}, green);
    if (options.closed) wall("front wall", {w, 0, d}, {-2 * w, 0, 0}, {0, h, 0}, white);
    if (!options.blocks) return;
    builder.begin_object("short block");
    add_block(builder, {0.925f, 0, 1.106f}, {1.65f, 1.65f, 1.65f}, -0.297, white);
    builder.begin_object("tall block");
    add_block(builder, {-0.905f, 0, -0.717f}, {1.65f, 3.3f, 1.65f}, 0.301, white);
}

void add_lamp(SceneBuilder& builder, const CornellOptions& options) {
    Material lamp = diffuse("lamp", {0.78f, 0.78f, 0.78f});
    lamp.emission = options.lamp_radiance;
    PatchOptions patch;
    patch.material = builder.material(lamp);
    builder.begin_object("lamp");
    builder.quad({-0.65f, k_height - 0.01f, -0.525f}, {1.3f, 0, 0}, {0, 0, 1.05f}, patch);
}

}  // namespace

Scene cornell_scene(const CornellOptions& options) {
    SceneBuilder builder(options.closed ? "cornell-closed" : "cornell");
    add_walls(builder, options);
    add_lamp(builder, options);
    Scene scene = builder.finish({.grid = 256, .padding = 4});

    // Place the camera in front of the open side, with the original's field of view; or just inside the front wall.
    Camera camera;
    camera.name = "camera";
    camera.world_from_camera.translation = {0, 0.5f * k_height, k_half_depth + (options.closed ? -0.1f : 8.0f)};
    camera.vertical_field_of_view = options.closed ? 1.4f : 0.686f;
    scene.cameras.push_back(camera);
    return scene;
}

}  // namespace lobelia
