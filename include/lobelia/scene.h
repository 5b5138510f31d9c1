// What is baked: meshes, objects that place them, materials, textures, lights and cameras. Lengths are in metres.
// The model follows glTF 2.0 (Khronos 2021) and its extensions for lights, emission and specular reflection.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/image.h"
#include "lobelia/math.h"

namespace lobelia {

/// target_from_source: p is moved to rows * p + translation.
struct Transform {
    std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    Vec3 translation;
};
[[nodiscard]] constexpr Vec3 transform_vector(const Transform& t, Vec3 v) { return rotate(t.rows, v); }
[[nodiscard]] constexpr Vec3 transform_point(const Transform& t, Vec3 p) { return rotate(t.rows, p) + t.translation; }

/// 8-bit RGBA, row by row from the top left (uv (0, 0)); which curve decodes it is its use's to say.
struct Texture {
    enum class Wrap { repeat, mirror, clamp };
    enum class Filter { linear, nearest };  ///< between texels: bilinear, or none
    std::string name;
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<std::array<std::uint8_t, 4>> texels;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
};

/// A texture as a material reads it: at rows * (u, v, 1) of the mesh's uv set 0 or 1 (KHR_texture_transform).
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
    std::optional<TextureUse> base_color_texture;  ///< its alpha channel, too
    float metallic = 0;
    float roughness = 1;
    std::optional<TextureUse> metallic_roughness_texture;  ///< roughness in G, metallic in B
    Rgb emission;  ///< radiance that leaves every point of the front [W/(m^2 sr)], factor times strength
    std::optional<TextureUse> emissive_texture;
    Alpha alpha_mode = Alpha::opaque;
    float alpha_cutoff = 0.5f;  ///< of Alpha::mask; Alpha::blend lets 1 - alpha of the light through unchanged
    bool double_sided = false;  ///< otherwise the back reflects and emits nothing, and light passes through it
    bool unlit = false;         ///< shown as base_color, and baked as a black surface that emits nothing
    float ior = 1.5f;           ///< KHR_materials_ior
    float specular = 1;         ///< KHR_materials_specular: strength of the dielectric reflection
    Rgb specular_color{1, 1, 1};
};

/// Triangles in object space, counter-clockwise from the front.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;            ///< unit, one for each position; or empty: flat triangles
    std::array<std::vector<Vec2>, 2> uv;  ///< for textures; each has one for each position, or is empty
    std::vector<Vec2> lightmap_uv;        ///< likewise; empty: this mesh cannot be baked, but is there for the light
    std::vector<std::array<float, 4>> colors;  ///< linear RGBA factors of base_color (COLOR_0), or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> materials;  ///< one for each triangle
};

/// A mesh in its place in the world.
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
    Vec3 direction;         ///< spot, directional: unit, the way the light travels
    float inner_angle = 0;  ///< spot: half angle of the full cone [radians]; that of the outer one: a hard edge
    float outer_angle = 0;  ///< spot: half angle beyond which it is dark [radians]
    float angular_radius = 0;  ///< directional: of the disc in the sky [radians], 0 for a parallel beam
    float range = 0;           ///< point, spot: glTF's cut-off distance [m]; 0: none
};

/// A camera looks along its -z, +y is up, +x is right.
struct Camera {
    std::string name;
    Transform world_from_camera;
    float vertical_field_of_view = 0.8f;  ///< [radians]
};

/// All of it. Indices are in range, numbers finite, materials not empty where there are triangles: whoever makes a
/// scene sees to that (read_gltf does, check_scene tells).
struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Object> objects;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;
    std::optional<Image> environment;  ///< latitude-longitude, y up; none: black
    /// The position of (0, 0, 0) in the world that the scene comes from [m]: a scene far from the world's origin is
    /// moved near zero, or its float positions would lie too far apart.
    std::array<double, 3> origin{};
};

}  // namespace lobelia
