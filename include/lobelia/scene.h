// The scene to bake: meshes, objects that place them, materials, textures, lights and cameras. Lengths are in metres.
// The model follows glTF 2.0 (Khronos 2021) and its extensions for lights, emission and specular reflection.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/image.h"
#include "lobelia/math.h"

namespace lobelia {

/// An affine transform, named target_from_source: p becomes rows * p + translation.
struct Transform {
    std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 translation;
};
[[nodiscard]] constexpr Vec3 transform_vector(const Transform& t, Vec3 v) { return rotate(t.rows, v); }
[[nodiscard]] constexpr Vec3 transform_point(const Transform& t, Vec3 p) { return rotate(t.rows, p) + t.translation; }

/// 8-bit RGBA, row by row from the top left (uv (0, 0)); each use determines whether it is sRGB or linear.
struct Texture {
    enum class Wrap { repeat, mirror, clamp };
    enum class Filter { linear, nearest };  ///< interpolation between texels: bilinear, or none
    std::string name;
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
};

/// A material's use of a texture, sampled at rows * (u, v, 1) of the mesh's uv set 0 or 1 (KHR_texture_transform).
struct TextureUse {
    std::size_t texture = 0;
    std::size_t uv_set = 0;
    std::array<std::array<float, 3>, 2> uv_from_mesh{{{1, 0, 0}, {0, 1, 0}}};
};

/// glTF's metallic-roughness material. Factors are linear; textures of colour are sRGB, the others linear.
struct Material {
    enum class Alpha { opaque, mask, blend };
    std::string name;
    Rgb base_color{1, 1, 1};
    float alpha = 1;
    std::optional<TextureUse> base_color_texture;  ///< including its alpha channel
    float metallic = 0;
    float roughness = 1;
    std::optional<TextureUse> metallic_roughness_texture;  ///< roughness in G, metallic in B
    Rgb emission;  ///< radiance emitted by every point of the front [W/(m^2 sr)], factor times strength
    std::optional<TextureUse> emissive_texture;
    Alpha alpha_mode = Alpha::opaque;
    float alpha_cutoff = 0.5f;  ///< for Alpha::mask; Alpha::blend transmits 1 - alpha of the light unchanged
    bool double_sided = false;  ///< false: the back reflects and emits nothing, and light passes through it
    bool unlit = false;         ///< shown as base_color, and baked as a black surface that emits nothing
    float ior = 1.5f;           ///< KHR_materials_ior
    float specular = 1;         ///< KHR_materials_specular: strength of the dielectric reflection
    Rgb specular_color{1, 1, 1};
};

/// Triangles in object space, counter-clockwise from the front.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;            ///< unit, one per position; or empty: flat triangles
    std::array<std::vector<Vec2>, 2> uv;  ///< for textures; each has one entry per position, or is empty
    std::vector<Vec2> lightmap_uv;        ///< likewise; empty: the mesh is not baked, but reflects and blocks light
    std::vector<std::array<float, 4>> colors;  ///< linear RGBA factors of base_color (COLOR_0), or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> materials;  ///< one per triangle
};

/// A mesh placed in the world.
struct Object {
    std::string name;
    std::size_t mesh = 0;
    Transform world_from_object;
};

/// THE list of kinds of lights. To add one, write src/scene/light/NAME.cpp, which defines `lights::NAME`, and put the
/// name here, at the end.
#define LOBELIA_LIGHT_KINDS(kind) kind(point) kind(spot) kind(directional)

/// A light without a surface (KHR_lights_punctual).
struct PunctualLight {
    /// point, spot and so on: an enumerator for each name of the list.
    enum class Kind {
#define LOBELIA_ENUMERATOR(name) name,
        LOBELIA_LIGHT_KINDS(LOBELIA_ENUMERATOR)
#undef LOBELIA_ENUMERATOR
    };
    std::string name;
    Kind kind = Kind::point;
    Rgb intensity;          ///< point, spot: radiant intensity [W/sr]; directional: irradiance across the beam [W/m^2]
    Vec3 position;          ///< point, spot
    Vec3 direction;         ///< spot, directional: unit, in which the light travels
    float inner_angle = 0;  ///< spot: half angle of the full cone [radians]; equal to outer_angle: a hard edge
    float outer_angle = 0;  ///< spot: half angle beyond which there is no light [radians]
    float angular_radius = 0;  ///< directional: angular radius of the disc in the sky [radians], 0 for a parallel beam
    float range = 0;           ///< point, spot: glTF's cut-off distance [m]; 0: none
};

/// A camera looks along its -z, +y is up, +x is right.
struct Camera {
    std::string name;
    Transform world_from_camera;
    float vertical_field_of_view = 0.8f;  ///< [radians]
};

/// A complete scene. Indices are in range, numbers finite, materials not empty if there are triangles: code that makes
/// a scene must ensure this (read_gltf does; check_scene tests it).
struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;
    std::optional<Image> environment;  ///< latitude-longitude, y up; none: black
    /// The position of (0, 0, 0) in the original world [m]. A scene far from its world's origin is moved near zero,
    /// because float positions would be too coarse there.
    std::array<double, 3> origin{};
};

}  // namespace lobelia
