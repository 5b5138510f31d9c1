// Tests the scene hash: the same on every machine, and different for every change.
#include "scene/scene_hash.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace lobelia {
namespace {

/// A scene with a value in every field.
Scene full_scene() {
    Scene s;
    s.name = "scene";
    Mesh mesh;
    mesh.name = "mesh";
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.uv = {{{{0, 0}, {1, 0}, {0, 1}}, {{0, 0}, {2, 0}, {0, 2}}}};
    mesh.lightmap_uv = {{0, 0}, {0.5f, 0}, {0, 0.5f}};
    mesh.colors = {{1, 1, 1, 1}, {1, 0, 1, 1}, {1, 1, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    mesh.materials = {0};
    s.meshes = {mesh, mesh};
    s.objects = {{"object", 0, {}}};
    Material material;
    material.name = "material";
    material.base_color_texture = TextureUse{0, 1, {}};
    s.materials = {material};
    s.textures = {{"texture", 1, 2, {{1, 2, 3, 4}, {5, 6, 7, 8}}}};
    s.lights = {{"light", PunctualLight::Kind::spot, {1, 2, 3}, {4, 5, 6}, {0, 0, 1}, 0.1f, 0.2f, 0.3f, 7}};
    s.cameras = {{"camera", {}, 0.9f}};
    s.environment = Image(2, 1);
    return s;
}

TEST(SceneHash, EveryChangeGivesAnother) {
    const std::vector<std::function<void(Scene&)>> changes = {
        [](Scene& s) { s.name = "scenf"; },
        [](Scene& s) { s.meshes[1].name = ""; },
        [](Scene& s) { s.meshes[1].positions[2].z = 1e-30f; },
        [](Scene& s) { s.meshes[1].normals[0].z = -1; },
        [](Scene& s) { s.meshes[0].normals.clear(); },
        [](Scene& s) { s.meshes[0].uv[0][1].x = 2; },
        [](Scene& s) { std::swap(s.meshes[0].uv[0], s.meshes[0].uv[1]); },
        [](Scene& s) { s.meshes[0].lightmap_uv[1].x = 0.25f; },
        [](Scene& s) { s.meshes[0].colors[2][3] = 0; },
        [](Scene& s) {
            s.meshes[0].triangles[0] = {1, 2, 0};
        },
        [](Scene& s) { s.meshes[0].materials[0] = 1; },
        [](Scene& s) { s.meshes.pop_back(); },
        [](Scene& s) { s.objects[0].name += " "; },
        [](Scene& s) { s.objects[0].mesh = 1; },
        [](Scene& s) { s.objects[0].world_from_object.translation.x = 1; },
        [](Scene& s) { s.objects[0].world_from_object.rows[1].y = 2; },
        [](Scene& s) { s.materials[0].name = "m"; },
        [](Scene& s) { s.materials[0].base_color.g = 0.5f; },
        [](Scene& s) { s.materials[0].alpha = 0.5f; },
        [](Scene& s) { s.materials[0].base_color_texture.reset(); },
        [](Scene& s) { std::swap(s.materials[0].base_color_texture, s.materials[0].emissive_texture); },
        [](Scene& s) { s.materials[0].base_color_texture->uv_set = 0; },
        [](Scene& s) { s.materials[0].base_color_texture->uv_from_mesh[1][2] = 3; },
        [](Scene& s) { s.materials[0].metallic = 0.5f; },
        [](Scene& s) { s.materials[0].roughness = 0.5f; },
        [](Scene& s) { s.materials[0].emission.b = 0.5f; },
        [](Scene& s) { s.materials[0].alpha_mode = Material::Alpha::blend; },
        [](Scene& s) { s.materials[0].alpha_cutoff = 0.25f; },
        [](Scene& s) { s.materials[0].double_sided = true; },
        [](Scene& s) { s.materials[0].unlit = true; },
        [](Scene& s) { s.materials[0].ior = 1.25f; },
        [](Scene& s) { s.materials[0].specular = 0.25f; },
        [](Scene& s) { s.materials[0].specular_color.r = 0.25f; },
        [](Scene& s) { s.textures[0].texels[1][3] = 9; },
        [](Scene& s) { std::swap(s.textures[0].width, s.textures[0].height); },
        [](Scene& s) { s.textures[0].wrap_u = Texture::Wrap::clamp; },
        [](Scene& s) { s.textures[0].wrap_v = Texture::Wrap::clamp; },
        [](Scene& s) { s.textures[0].filter = Texture::Filter::nearest; },
        [](Scene& s) { s.origin[1] = 5; },
        [](Scene& s) { s.lights[0].kind = PunctualLight::Kind::point; },
        [](Scene& s) { s.lights[0].intensity.r = 2; },
        [](Scene& s) { s.lights[0].position.y = 2; },
        [](Scene& s) {
            s.lights[0].direction = {0, 1, 0};
        },
        [](Scene& s) { std::swap(s.lights[0].inner_angle, s.lights[0].outer_angle); },
        [](Scene& s) { s.lights[0].angular_radius = 1; },
        [](Scene& s) { s.lights[0].range = 1; },
        [](Scene& s) { s.cameras[0].vertical_field_of_view = 1; },
        [](Scene& s) { s.cameras.clear(); },
        [](Scene& s) { s.environment.reset(); },
        [](Scene& s) { s.environment->pixels[1].r = 1; },
    };
    std::set<std::uint64_t> seen = {scene_hash(full_scene())};
    for (std::size_t i = 0; i < changes.size(); ++i) {
        Scene scene = full_scene();
        changes[i](scene);
        EXPECT_TRUE(seen.insert(scene_hash(scene)).second) << "change " << i;
    }
}

TEST(SceneHash, NeverChangesForTheSameScene) {
    // Bakes and checkpoints store this hash: if it changes here, they no longer match their scenes.
    EXPECT_EQ(scene_hash(Scene{}), 17846105203780815389u);
    EXPECT_EQ(scene_hash(full_scene()), 1078977479924493605u);
}

}  // namespace
}  // namespace lobelia
