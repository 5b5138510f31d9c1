// A scene's hash, field after field.
#include "scene/scene_hash.h"

#include <bit>
#include <type_traits>

#include "core/math/hash.h"

namespace lobelia {
namespace {

/// A type of this file, so that all add() below are found for it.
struct SceneHash : Hash {};

void add(SceneHash& hash, float value) { hash.word(std::bit_cast<std::uint32_t>(value)); }
void add(SceneHash& hash, bool value) { hash.word(value ? 1 : 0); }
void add(SceneHash& hash, const std::string& text) { hash.bytes(text.data(), text.size()); }
template <class T>
requires std::is_enum_v<T> ||(std::is_integral_v<T> && !std::is_same_v<T, bool>)void add(SceneHash& hash, T value) {
    hash.word(static_cast<std::uint64_t>(value));
}

// Hashes types without padding as bytes, whole arrays at once.
template <class T>
concept Packed = std::is_same_v<T, Vec2> || std::is_same_v<T, Vec3> || std::is_same_v<T, Rgb> ||
    std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::array<float, 4>> ||
    std::is_same_v<T, std::array<std::uint8_t, 4>> || std::is_same_v<T, std::array<std::uint32_t, 3>>;
static_assert(sizeof(Vec2) == 8 && sizeof(Vec3) == 12 && sizeof(Rgb) == 12 && sizeof(std::array<float, 4>) == 16);
template <Packed T>
requires std::is_class_v<T>
void add(SceneHash& hash, const T& value) { hash.bytes(&value, sizeof value); }
template <Packed T>
void add(SceneHash& hash, const std::vector<T>& values) {
    hash.bytes(values.data(), values.size() * sizeof(T));
}
template <class T>
requires(!Packed<T>) void add(SceneHash& hash, const std::vector<T>& values);
template <class T>
void add(SceneHash& hash, const std::optional<T>& value);

template <class... T>
void add_all(SceneHash& hash, const T&... values) {
    (add(hash, values), ...);
}

void add(SceneHash& hash, const Transform& t) {
    for (const Vec3& row : t.rows) add(hash, row);
    add(hash, t.translation);
}
void add(SceneHash& hash, const Texture& t) {
    add_all(hash, t.name, t.width, t.height, t.texels, t.wrap_u, t.wrap_v);
    // Hash fields added later only if they are set, so that hashes of older scenes stay the same.
    if (t.filter != Texture::Filter::linear) add(hash, t.filter);
}
void add(SceneHash& hash, const TextureUse& use) {
    add_all(hash, use.texture, use.uv_set);
    for (const auto& row : use.uv_from_mesh)
        for (float value : row) add(hash, value);
}
void add(SceneHash& hash, const Material& m) {
    add_all(hash, m.name, m.base_color, m.alpha, m.base_color_texture, m.metallic, m.roughness,
            m.metallic_roughness_texture, m.emission, m.emissive_texture, m.alpha_mode, m.alpha_cutoff, m.double_sided,
            m.unlit, m.ior, m.specular, m.specular_color);
}
void add(SceneHash& hash, const Mesh& m) {
    add_all(hash, m.name, m.positions, m.normals, m.uv[0], m.uv[1], m.lightmap_uv, m.colors, m.triangles, m.materials);
}
void add(SceneHash& hash, const Object& o) { add_all(hash, o.name, o.mesh, o.world_from_object); }
void add(SceneHash& hash, const PunctualLight& l) {
    add_all(hash, l.name, l.kind, l.intensity, l.position, l.direction, l.inner_angle, l.outer_angle, l.angular_radius,
            l.range);
}
void add(SceneHash& hash, const Camera& c) { add_all(hash, c.name, c.world_from_camera, c.vertical_field_of_view); }
void add(SceneHash& hash, const Image& image) { add_all(hash, image.width, image.height, image.pixels); }

template <class T>
requires(!Packed<T>) void add(SceneHash& hash, const std::vector<T>& values) {
    hash.word(values.size());
    for (const T& value : values) add(hash, value);
}
template <class T>
void add(SceneHash& hash, const std::optional<T>& value) {
    add(hash, value.has_value());
    if (value) add(hash, *value);
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
    SceneHash hash;
    add_all(hash, scene.name, scene.meshes, scene.objects, scene.materials, scene.textures, scene.lights, scene.cameras,
            scene.environment);
    if (scene.origin != Scene{}.origin)
        for (const double x : scene.origin) hash.word(std::bit_cast<std::uint64_t>(x));
    return hash.value();
}

}  // namespace lobelia
