// Checks a scene against the promises of scene.h.
#include "scene/check_scene.h"

#include <fmt/format.h>

#include <span>

#include "scene/light/light_kind.h"

namespace lobelia {
namespace {

bool finite(float x) { return std::isfinite(x); }
bool finite(Vec2 v) { return finite(v.x) && finite(v.y); }
bool finite(Vec3 v) { return finite(v.x) && finite(v.y) && finite(v.z); }
bool finite(const Transform& t) {
    return finite(t.rows[0]) && finite(t.rows[1]) && finite(t.rows[2]) && finite(t.translation);
}
bool is_positive(Rgb c) { return finite(c.r) && finite(c.g) && finite(c.b) && c.r >= 0 && c.g >= 0 && c.b >= 0; }
/// Upper limit of light, as for the texels of environments: above it sums of several and their squares overflow.
constexpr float k_most_light = 1e15f;
bool is_light(Rgb c) { return is_positive(c) && c.r <= k_most_light && c.g <= k_most_light && c.b <= k_most_light; }
bool in_unit(float x) { return x >= 0 && x <= 1; }
bool in_unit(const std::array<float, 4>& c) { return in_unit(c[0]) && in_unit(c[1]) && in_unit(c[2]) && in_unit(c[3]); }
bool is_reflectance(Rgb c) { return in_unit(c.r) && in_unit(c.g) && in_unit(c.b); }
bool is_unit(Vec3 v) { return finite(v) && std::abs(length(v) - 1) < 1e-3f; }

/// Makes an error from the path of an element and its fault.
template <class... T>
Error wrong(std::string_view what, fmt::format_string<T...> place, T&&... values) {
    return Error{fmt::format("{}: {}", fmt::format(place, std::forward<T>(values)...), what)};
}

/// Checks an array parallel to the positions: as many entries, or none where that is allowed; each valid.
template <class T, class Good>
Status check_array(std::span<const T> values, std::size_t count, std::string_view place, Good good) {
    if (values.size() != count) return wrong(fmt::format("{} entries for {}", values.size(), count), "{}", place);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!good(values[i])) return wrong("not finite or out of its range", "{}[{}]", place, i);
    return Done{};
}

template <class T, class Good>
Status check_optional(const std::vector<T>& values, std::size_t count, std::string_view place, Good good) {
    if (values.empty()) return Done{};
    return check_array(std::span<const T>(values), count, place, good);
}

Status check_triangles(const Scene& scene, const Mesh& mesh, const std::string& place) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            if (v >= mesh.positions.size())
                return wrong(fmt::format("vertex {} of {}", v, mesh.positions.size()), "{}.triangles[{}]", place, t);
    return check_array(std::span<const std::uint32_t>(mesh.materials), mesh.triangles.size(), place + ".materials",
                       [&](std::uint32_t m) { return m < scene.materials.size(); });
}

Status check_mesh(const Scene& scene, const Mesh& mesh, const std::string& place) {
    const std::size_t count = mesh.positions.size();
    const auto finite_2 = [](Vec2 v) { return finite(v); };
    if (auto s = check_optional(mesh.positions, count, place + ".positions", [](Vec3 v) { return finite(v); }); !s)
        return s;
    if (auto s = check_optional(mesh.normals, count, place + ".normals", is_unit); !s) return s;
    for (std::size_t set = 0; set < 2; ++set)
        if (auto s = check_optional(mesh.uv[set], count, fmt::format("{}.uv[{}]", place, set), finite_2); !s) return s;
    if (auto s = check_optional(mesh.lightmap_uv, count, place + ".lightmap_uv", finite_2); !s) return s;
    if (auto s = check_optional(mesh.colors, count, place + ".colors",
                                [](const std::array<float, 4>& c) { return in_unit(c); });
        !s)
        return s;
    return check_triangles(scene, mesh, place);
}

Status check_use(const Scene& scene, const std::optional<TextureUse>& use, const std::string& place) {
    if (!use) return Done{};
    if (use->texture >= scene.textures.size())
        return wrong(fmt::format("texture {} of {}", use->texture, scene.textures.size()), "{}", place);
    if (use->uv_set > 1) return wrong("the uv set is neither 0 nor 1", "{}", place);
    for (const auto& row : use->uv_from_mesh)
        for (const float x : row)
            if (!finite(x)) return wrong("the transform is not finite", "{}", place);
    return Done{};
}

Status check_material(const Scene& scene, const Material& m, const std::string& place) {
    if (!is_reflectance(m.base_color) || !in_unit(m.alpha) || !in_unit(m.metallic) || !in_unit(m.roughness) ||
        !in_unit(m.specular))
        return wrong("a factor is not in [0, 1]", "{}", place);
    if (!is_light(m.emission)) return wrong("negative or above 1e15", "{}.emission", place);
    if (!is_positive(m.specular_color)) return wrong("negative or not finite", "{}.specular_color", place);
    if (!finite(m.alpha_cutoff) || m.alpha_cutoff < 0) return wrong("negative or not finite", "{}.alpha_cutoff", place);
    if (!finite(m.ior) || (m.ior < 1 && m.ior != 0)) return wrong("neither 0 nor at least 1", "{}.ior", place);
    if (auto s = check_use(scene, m.base_color_texture, place + ".base_color_texture"); !s) return s;
    if (auto s = check_use(scene, m.metallic_roughness_texture, place + ".metallic_roughness_texture"); !s) return s;
    return check_use(scene, m.emissive_texture, place + ".emissive_texture");
}

Status check_light(const PunctualLight& light, const std::string& place) {
    if (!is_light(light.intensity)) return wrong("negative or above 1e15", "{}.intensity", place);
    if (!finite(light.position)) return wrong("not finite", "{}.position", place);
    const LightKind& kind = light_kind(light.kind);
    if (kind.aim == LightAim::along_direction && !is_unit(light.direction))
        return wrong("not of length 1", "{}.direction", place);
    const std::string_view problem = kind.problem != nullptr ? kind.problem(light) : "";
    if (!problem.empty()) return wrong(problem, "{}", place);
    if (!(light.angular_radius >= 0 && light.angular_radius < 1.5708f))
        return wrong("not in [0, pi / 2)", "{}.angular_radius", place);
    if (!finite(light.range) || light.range < 0) return wrong("negative or not finite", "{}.range", place);
    return Done{};
}

Status check_rest(const Scene& scene) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (scene.objects[i].mesh >= scene.meshes.size())
            return wrong(fmt::format("mesh {} of {}", scene.objects[i].mesh, scene.meshes.size()), "objects[{}]", i);
        if (!finite(scene.objects[i].world_from_object)) return wrong("the transform is not finite", "objects[{}]", i);
    }
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Texture& t = scene.textures[i];
        if (t.width == 0 || t.height == 0 || t.texels.size() != t.width * t.height)
            return wrong(fmt::format("{} texels for {} x {}", t.texels.size(), t.width, t.height), "textures[{}]", i);
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const Camera& camera = scene.cameras[i];
        if (!finite(camera.world_from_camera) ||
            !(camera.vertical_field_of_view > 0 && camera.vertical_field_of_view < 3.1416f))
            return wrong("the transform is not finite, or the field of view not in (0, pi)", "cameras[{}]", i);
    }
    if (!scene.environment) return Done{};
    const Image& image = *scene.environment;
    if (image.width == 0 || image.height == 0) return wrong("no texels", "environment");
    return check_array(std::span<const Rgb>(image.pixels), image.width * image.height, "environment", is_light);
}

}  // namespace

Status check_scene(const Scene& scene) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        if (auto s = check_mesh(scene, scene.meshes[i], fmt::format("meshes[{}]", i)); !s) return s;
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (auto s = check_material(scene, scene.materials[i], fmt::format("materials[{}]", i)); !s) return s;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        if (auto s = check_light(scene.lights[i], fmt::format("lights[{}]", i)); !s) return s;
    return check_rest(scene);
}

}  // namespace lobelia
