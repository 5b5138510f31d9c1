// Compares two scenes, except for rounding by the file format.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/scene.h"

namespace lobelia::test {

inline void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-6f) { EXPECT_LE(length(a - b), tolerance); }

inline void expect_same(const Transform& a, const Transform& b) {
    for (std::size_t i = 0; i < 3; ++i) expect_near(a.rows[i], b.rows[i]);
    EXPECT_EQ(a.translation, b.translation);
}

inline void expect_same(const std::optional<TextureUse>& a, const std::optional<TextureUse>& b) {
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) return;
    EXPECT_EQ(a->texture, b->texture);
    EXPECT_EQ(a->uv_set, b->uv_set);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(a->uv_from_mesh[i / 3][i % 3], b->uv_from_mesh[i / 3][i % 3], 1e-6f);
}

inline void expect_same(const Mesh& a, const Mesh& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.positions, b.positions);
    ASSERT_EQ(a.normals.size(), b.normals.size());
    for (std::size_t i = 0; i < a.normals.size(); ++i) expect_near(a.normals[i], b.normals[i]);
    EXPECT_EQ(a.uv[0], b.uv[0]);
    EXPECT_EQ(a.uv[1], b.uv[1]);
    EXPECT_EQ(a.lightmap_uv, b.lightmap_uv);
    EXPECT_EQ(a.colors, b.colors);
    // Triangles keep their order within a material.
    const auto sorted = [](const Mesh& mesh) {
        std::vector<std::pair<std::uint32_t, std::array<std::uint32_t, 3>>> list;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) list.emplace_back(mesh.materials[t], mesh.triangles[t]);
        std::stable_sort(list.begin(), list.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
        return list;
    };
    EXPECT_EQ(sorted(a), sorted(b));
}

inline void expect_same(const Material& a, const Material& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.base_color, b.base_color);
    EXPECT_EQ(a.alpha, b.alpha);
    EXPECT_EQ(a.metallic, b.metallic);
    EXPECT_EQ(a.roughness, b.roughness);
    EXPECT_NEAR(a.emission.r, b.emission.r, 1e-6f * a.emission.r);
    EXPECT_NEAR(a.emission.g, b.emission.g, 1e-6f * a.emission.g);
    EXPECT_NEAR(a.emission.b, b.emission.b, 1e-6f * a.emission.b);
    EXPECT_EQ(a.alpha_mode, b.alpha_mode);
    if (a.alpha_mode == Material::Alpha::mask) {
        EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
    }
    EXPECT_EQ(a.double_sided, b.double_sided);
    EXPECT_EQ(a.unlit, b.unlit);
    EXPECT_EQ(a.ior, b.ior);
    EXPECT_EQ(a.specular, b.specular);
    EXPECT_EQ(a.specular_color, b.specular_color);
    expect_same(a.base_color_texture, b.base_color_texture);
    expect_same(a.metallic_roughness_texture, b.metallic_roughness_texture);
    expect_same(a.emissive_texture, b.emissive_texture);
}

inline void expect_same(const PunctualLight& a, const PunctualLight& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_NEAR(a.intensity.r, b.intensity.r, 1e-6f * a.intensity.r);
    EXPECT_NEAR(a.intensity.g, b.intensity.g, 1e-6f * a.intensity.g);
    EXPECT_NEAR(a.intensity.b, b.intensity.b, 1e-6f * a.intensity.b);
    EXPECT_EQ(a.position, b.position);
    expect_near(a.direction, b.direction);
    EXPECT_EQ(a.inner_angle, b.inner_angle);
    EXPECT_EQ(a.outer_angle, b.outer_angle);
    EXPECT_EQ(a.angular_radius, b.angular_radius);
    EXPECT_EQ(a.range, b.range);
}

inline void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.name, b.name);
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) expect_same(a.meshes[i], b.meshes[i]);
    ASSERT_EQ(a.objects.size(), b.objects.size());
    for (std::size_t i = 0; i < a.objects.size(); ++i) {
        EXPECT_EQ(a.objects[i].name, b.objects[i].name);
        EXPECT_EQ(a.objects[i].mesh, b.objects[i].mesh);
        expect_same(a.objects[i].world_from_object, b.objects[i].world_from_object);
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) expect_same(a.materials[i], b.materials[i]);
    ASSERT_EQ(a.textures.size(), b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i) {
        EXPECT_EQ(a.textures[i].name, b.textures[i].name);
        EXPECT_EQ(a.textures[i].texels, b.textures[i].texels);
        EXPECT_EQ(a.textures[i].width, b.textures[i].width);
        EXPECT_EQ(a.textures[i].wrap_u, b.textures[i].wrap_u);
        EXPECT_EQ(a.textures[i].wrap_v, b.textures[i].wrap_v);
        EXPECT_EQ(a.textures[i].filter, b.textures[i].filter);
    }
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) expect_same(a.lights[i], b.lights[i]);
    ASSERT_EQ(a.cameras.size(), b.cameras.size());
    for (std::size_t i = 0; i < a.cameras.size(); ++i) {
        EXPECT_EQ(a.cameras[i].name, b.cameras[i].name);
        EXPECT_EQ(a.cameras[i].vertical_field_of_view, b.cameras[i].vertical_field_of_view);
        expect_same(a.cameras[i].world_from_camera, b.cameras[i].world_from_camera);
    }
}

}  // namespace lobelia::test
