// Writes scenes to binary glTF 2.0 files (Khronos 2021).
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/json.h"
#include "io/write_file.h"
#include "lobelia/gltf.h"
#include "scene/gltf/document.h"
#include "scene/gltf/write_materials.h"
#include "scene/light/light_kind.h"

namespace lobelia {
namespace gltf {
namespace {

using nlohmann::json;

/// Returns the matrix, column by column; nothing for the identity.
std::optional<json> matrix(const Transform& t) {
    const auto& [x, y, z] = t.rows;
    if (t.translation == Vec3{} && t.rows == Transform{}.rows) return std::nullopt;
    return json{x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, t.translation.x, t.translation.y, t.translation.z,
                1};
}

/// Returns the transform of a node that looks along its -z in `direction`.
Transform looking_along(Vec3 position, Vec3 direction) {
    const Vec3 z = direction * -1;
    const Vec3 x = normalize(cross(std::abs(z.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, z)), y = cross(z, x);
    return {{Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}}, position};
}

/// Accessors of a mesh: one per attribute, and one of indices per material.
struct MeshAccessors {
    json attributes;
    std::vector<std::pair<std::uint32_t, std::size_t>> primitives;
};

class Writer {
  public:
    Writer(const Scene& scene, const GltfWriteOptions& options) : scene_(scene), options_(options) {
        // Use the second set for the lightmap only if all meshes do.
        for (const Mesh& mesh : scene.meshes)
            if (!mesh.uv[1].empty() && (mesh.uv[1] != mesh.lightmap_uv || !options.lightmap_uv.empty()))
                sets_.second_uv = 2;
    }

    Result<std::string> write() {
        if (const Status s = write_textures(builder_, scene_); !s) return s.error();
        if (const Status s = write_materials(builder_, scene_, sets_); !s) return s.error();
        write_lightmaps();
        for (std::size_t i = 0; i < scene_.objects.size(); ++i)
            if (const Status s = write_object(i); !s) return s.error();
        write_lights();
        write_cameras();
        move_to_origin();
        json scene = {{"nodes", nodes_}};
        if (nodes_.empty()) scene.erase("nodes");
        if (!scene_.name.empty()) scene["name"] = scene_.name;
        if (const Status s = add_extras(scene, options_.scene_extras, "the scene"); !s) return s.error();
        if (const Status s = add_extensions(builder_.root(), options_.extensions, "the file"); !s) return s.error();
        builder_.add("scenes", std::move(scene));
        return builder_.finish();
    }

  private:
    void add_node(json node, const std::string& name, const Transform& transform) {
        if (!name.empty()) node["name"] = name;
        if (auto m = matrix(transform)) node["matrix"] = *std::move(m);
        nodes_.push_back(builder_.add("nodes", std::move(node)));
    }

    /// Returns the JSON object in a text.
    static Result<json> object_in(const std::string& text, std::string_view what, std::string_view whose) {
        auto object = parse_json(text, fmt::format("the {} of {}", what, whose));
        if (!object) return object.error();
        if (!object->is_object()) return Error{fmt::format("the {} of {} are not a JSON object", what, whose)};
        return json(*std::move(object));
    }

    static Status add_extras(json& target, const std::string& text, std::string_view whose) {
        if (text.empty()) return Done{};
        auto extras = object_in(text, "extras", whose);
        if (!extras) return extras.error();
        target["extras"] = *std::move(extras);
        return Done{};
    }

    Status add_extensions(json& target, const std::string& text, std::string_view whose) {
        if (text.empty()) return Done{};
        auto extensions = object_in(text, "extensions", whose);
        if (!extensions) return extensions.error();
        for (auto& [name, content] : extensions->items()) {
            builder_.use_extension(name.c_str());
            target["extensions"][name] = std::move(content);
        }
        return Done{};
    }

    void write_lightmaps() {
        for (const GltfLightmap& lightmap : options_.lightmaps) {
            constexpr int k_filter = 9729, k_wrap = 33071;  // linear; clamped
            const std::size_t image =
                builder_.add("images", {{"bufferView", builder_.add_view(lightmap.png, 0)}, {"mimeType", "image/png"}});
            const std::size_t sampler = builder_.add(
                "samplers", {{"wrapS", k_wrap}, {"wrapT", k_wrap}, {"magFilter", k_filter}, {"minFilter", k_filter}});
            lightmap_textures_.push_back(builder_.add("textures", {{"source", image}, {"sampler", sampler}}));
        }
        if (!options_.lightmaps.empty()) builder_.use_extension("MOZ_lightmap");
    }

    /// Returns the index of a material for an object: its own, or a copy that has the object's lightmap.
    std::size_t material_of(std::size_t object, std::size_t material) {
        if (options_.object_lightmap.empty() || !options_.object_lightmap[object]) return material;
        const std::size_t lightmap = *options_.object_lightmap[object];
        const auto [entry, is_new] = lit_materials_.try_emplace({material, lightmap}, 0);
        if (is_new) {
            json copy = builder_.root()["materials"][material];
            copy["extensions"]["MOZ_lightmap"] = {{"index", lightmap_textures_[lightmap]},
                                                  {"texCoord", 1},
                                                  {"intensity", options_.lightmaps[lightmap].intensity}};
            entry->second = builder_.add("materials", std::move(copy));
        }
        return entry->second;
    }

    Status write_object(std::size_t i) {
        const Object& object = scene_.objects[i];
        json node = json::object();
        if (!scene_.meshes[object.mesh].triangles.empty()) node["mesh"] = mesh_of(i);
        if (!options_.object_extras.empty())
            if (const Status s = add_extras(node, options_.object_extras[i], object.name); !s) return s;
        if (!options_.object_extensions.empty())
            if (const Status s = add_extensions(node, options_.object_extensions[i], object.name); !s) return s;
        add_node(std::move(node), object.name, object.world_from_object);
        return Done{};
    }

    /// Returns the index of the file's mesh for an object: that of its own mesh, or a copy that differs only in the
    /// lightmap UVs and the materials' lightmap.
    std::size_t mesh_of(std::size_t i) {
        const std::size_t m = scene_.objects[i].mesh;
        const bool is_own = (!options_.lightmap_uv.empty() && !options_.lightmap_uv[i].empty()) ||
                            (!options_.object_lightmap.empty() && options_.object_lightmap[i]);
        if (const auto found = meshes_.find(m); found != meshes_.end() && !is_own) return found->second;
        MeshAccessors mesh = accessors_of(m);
        const auto add_lightmap = [&](const std::vector<Vec2>& values) {
            assert(values.size() == scene_.meshes[m].positions.size());
            mesh.attributes["TEXCOORD_1"] = builder_.add_vectors(values);
        };
        if (!options_.lightmap_uv.empty() && !options_.lightmap_uv[i].empty()) {
            add_lightmap(options_.lightmap_uv[i]);
        } else if (!scene_.meshes[m].lightmap_uv.empty()) {
            add_lightmap(scene_.meshes[m].lightmap_uv);
        }
        json out = json::object();
        if (fill_gaps(mesh.attributes)) out["extras"][k_no_lightmap] = true;
        json primitives;
        for (const auto& [material, indices] : mesh.primitives)
            primitives.push_back(
                {{"attributes", mesh.attributes}, {"indices", indices}, {"material", material_of(i, material)}});
        out["primitives"] = std::move(primitives);
        if (!scene_.meshes[m].name.empty()) out["name"] = scene_.meshes[m].name;
        const std::size_t index = builder_.add("meshes", std::move(out));
        if (!is_own) meshes_[m] = index;
        return index;
    }

    /// Copies texture coordinates to missing lower sets, because glTF numbers them without gaps. Returns whether the
    /// lightmap's set is a copy.
    static bool fill_gaps(json& attributes) {
        bool fills_lightmap = false;
        const std::array<std::string, 3> names{"TEXCOORD_2", "TEXCOORD_1", "TEXCOORD_0"};
        for (std::size_t k = 1; k < names.size(); ++k) {
            if (attributes.contains(names[k]) || !attributes.contains(names[k - 1])) continue;
            attributes[names[k]] = attributes[names[k - 1]];
            fills_lightmap |= k == 1;
        }
        return fills_lightmap;
    }

    /// Returns the accessors that all objects of a mesh share; written once.
    const MeshAccessors& accessors_of(std::size_t m) {
        if (const auto found = accessors_.find(m); found != accessors_.end()) return found->second;
        const Mesh& mesh = scene_.meshes[m];
        MeshAccessors& result = accessors_[m];
        result.attributes["POSITION"] = builder_.add_positions(mesh.positions);
        if (!mesh.normals.empty()) result.attributes["NORMAL"] = builder_.add_vectors(mesh.normals);
        if (!mesh.colors.empty()) result.attributes["COLOR_0"] = builder_.add_vectors(mesh.colors);
        if (!mesh.uv[0].empty()) result.attributes["TEXCOORD_0"] = builder_.add_vectors(mesh.uv[0]);
        if (!mesh.uv[1].empty() && sets_.second_uv == 2)
            result.attributes["TEXCOORD_2"] = builder_.add_vectors(mesh.uv[1]);

        // Group the indices by material, in the order of their first triangles.
        std::vector<std::uint32_t> order;
        std::map<std::uint32_t, std::vector<std::uint32_t>> indices;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            auto& list = indices[mesh.materials[t]];
            if (list.empty()) order.push_back(mesh.materials[t]);
            list.insert(list.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
        }
        for (const std::uint32_t material : order)
            result.primitives.emplace_back(material, builder_.add_indices(indices[material]));
        return result;
    }

    void write_lights() {
        json lights;
        for (const PunctualLight& light : scene_.lights) {
            const LightKind& kind = light_kind(light.kind);
            const double intensity = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
            const auto part = [&](float x) { return intensity > 0 ? x / intensity : 1; };
            json out = {{"type", kind.name},
                        {"intensity", intensity},
                        {"color", {part(light.intensity.r), part(light.intensity.g), part(light.intensity.b)}}};
            if (!light.name.empty()) out["name"] = light.name;
            if (light.range > 0) out["range"] = light.range;
            if (kind.write != nullptr) kind.write(light, out);
            json node;
            node["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
            lights.push_back(std::move(out));
            Transform place;
            place.translation = light.position;
            if (kind.aim == LightAim::along_direction) place = looking_along(light.position, light.direction);
            add_node(std::move(node), light.name, place);
        }
        if (lights.empty()) return;
        builder_.root()["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
        builder_.use_extension("KHR_lights_punctual");
    }

    void write_cameras() {
        for (const Camera& camera : scene_.cameras) {
            json out = {{"type", "perspective"},
                        {"perspective", {{"yfov", camera.vertical_field_of_view}, {"znear", 0.01}}}};
            if (!camera.name.empty()) out["name"] = camera.name;
            add_node({{"camera", builder_.add("cameras", std::move(out))}}, camera.name, camera.world_from_camera);
        }
    }

    /// Moves all nodes below a new one that restores the scene's position in the world.
    void move_to_origin() {
        const auto& [x, y, z] = scene_.origin;
        if ((x == 0 && y == 0 && z == 0) || nodes_.empty()) return;
        json root = {{"translation", {x, y, z}}, {"children", std::move(nodes_)}};
        nodes_ = json::array({builder_.add("nodes", std::move(root))});
    }

    const Scene& scene_;
    const GltfWriteOptions& options_;
    WriteSets sets_;
    GlbBuilder builder_;
    json nodes_ = json::array();
    std::map<std::size_t, std::size_t> meshes_;
    std::map<std::size_t, MeshAccessors> accessors_;
    std::vector<std::size_t> lightmap_textures_;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> lit_materials_;  ///< by material and lightmap
};

}  // namespace
}  // namespace gltf

Result<std::string> encode_glb(const Scene& scene, const GltfWriteOptions& options) {
    assert(options.lightmap_uv.empty() || options.lightmap_uv.size() == scene.objects.size());
    assert(options.object_extras.empty() || options.object_extras.size() == scene.objects.size());
    assert(options.object_extensions.empty() || options.object_extensions.size() == scene.objects.size());
    assert(options.object_lightmap.empty() || options.object_lightmap.size() == scene.objects.size());
    return gltf::Writer(scene, options).write();
}

Status write_gltf(const std::filesystem::path& path, const Scene& scene, const GltfWriteOptions& options) {
    const Result<std::string> bytes = encode_glb(scene, options);
    if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message)};
    return write_file_atomically(path, *bytes);
}

}  // namespace lobelia
