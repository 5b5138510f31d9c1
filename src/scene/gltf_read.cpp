// Scenes from glTF 2.0 files (Khronos 2021).
#include "scene/gltf_read.h"

#include <cassert>

#include "io/counted.h"
#include "io/read_file.h"
#include "scene/check_scene.h"
#include "scene/gltf_lights.h"
#include "scene/gltf_meshes.h"

namespace lobelia {
namespace gltf {
namespace {

/// The meshes that placed nodes show, by their index in the file.
Result<std::vector<std::optional<std::size_t>>> read_meshes(MeshContext& context, const std::vector<PlacedNode>& nodes,
                                                            Scene& scene) {
    const auto& model = context.document.model;
    std::vector<bool> used(model.meshes.size());
    for (const PlacedNode& placed : nodes) {
        const tinygltf::Node& node = model.nodes[placed.node];
        if (node.mesh < 0) continue;
        const std::string place = fmt::format("nodes[{}]", placed.node);
        if (static_cast<std::size_t>(node.mesh) >= used.size())
            return context.document.error(place + ".mesh", fmt::format("{} of {}", node.mesh, used.size()));
        if (node.skin >= 0) context.document.warn(place, "its skin is not read; it stands as it was modelled");
        used[static_cast<std::size_t>(node.mesh)] = true;
    }
    std::vector<std::optional<std::size_t>> of_mesh(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        auto mesh = read_mesh(context, i);
        if (!mesh) return mesh.error();
        if (mesh->triangles.empty()) continue;
        of_mesh[i] = scene.meshes.size();
        scene.meshes.push_back(*std::move(mesh));
    }
    return of_mesh;
}

/// "name", or what it is for want of one.
std::string name_or(const std::string& name, std::string_view kind, std::size_t index) {
    return name.empty() ? fmt::format("{} {}", kind, index) : name;
}

Status add_objects(Document& document, const PlacedNode& placed, std::size_t mesh, Scene& scene,
                   std::size_t& triangles) {
    // Count before making them.
    const auto copies = instances_of(document, placed.node);
    if (!copies) return copies.error();
    const std::string place = fmt::format("nodes[{}]", placed.node);
    const GltfReadOptions& options = document.options;
    if (copies->size() > options.most_objects - scene.objects.size())
        return document.error(place, fmt::format("more than {} objects", options.most_objects));
    const std::size_t each = scene.meshes[mesh].triangles.size();
    if (copies->size() > (options.most_triangles - triangles) / each)
        return document.error(place, fmt::format("more than {} triangles in all objects", options.most_triangles));
    triangles += copies->size() * each;

    const tinygltf::Node& node = document.model.nodes[placed.node];
    const std::string name =
        node.name.empty() ? name_or(scene.meshes[mesh].name, "node", placed.node) : short_name(node.name);
    for (std::size_t i = 0; i < copies->size(); ++i) {
        Object object;
        object.name = copies->size() == 1 ? name : fmt::format("{} {}", name, i);
        object.mesh = mesh;
        object.world_from_object = product(placed.world_from_node, (*copies)[i]);
        scene.objects.push_back(std::move(object));
    }
    return Done{};
}

void warn_of_totals(Document& document, const MeshTotals& totals) {
    if (totals.no_area > 0)
        document.warn("meshes", fmt::format("{} without area, the first is {}", counted(totals.no_area, "triangle"),
                                            totals.first_no_area));
    if (totals.repaired_normals > 0)
        document.warn("meshes", counted(totals.repaired_normals, "normal") +
                                    " without a direction; made from the triangles around them");
    if (document.more_warnings > 0)
        document.warnings.push_back("and " + counted(document.more_warnings, "more warning"));
}

Result<LoadedScene> read(Document& document) {
    // Materials first: they say which texture coordinates are needed.
    LoadedScene loaded;
    Scene& scene = loaded.scene;
    const auto uv_sets = read_materials(document, scene);
    if (!uv_sets) return uv_sets.error();
    const auto nodes = placed_nodes(document);
    if (!nodes) return nodes.error();
    MeshContext context{document, *uv_sets, static_cast<std::uint32_t>(scene.materials.size()), false, {}};
    const auto of_mesh = read_meshes(context, *nodes, scene);
    if (!of_mesh) return of_mesh.error();
    if (context.uses_default) scene.materials.emplace_back().name = "default";
    if (scene.meshes.empty()) return Error{fmt::format("{}: there are no triangles in the scene", document.name)};

    // Then what stands where.
    std::size_t triangles = 0;
    for (const PlacedNode& placed : *nodes) {
        const int mesh = document.model.nodes[placed.node].mesh;
        if (mesh < 0 || !(*of_mesh)[static_cast<std::size_t>(mesh)]) continue;
        const std::size_t index = *(*of_mesh)[static_cast<std::size_t>(mesh)];
        if (const Status s = add_objects(document, placed, index, scene, triangles); !s) return s.error();
    }
    if (const Status s = read_lights_and_cameras(document, *nodes, scene); !s) return s.error();
    const auto& scenes = document.model.scenes;
    const auto chosen = static_cast<std::size_t>(std::max(document.model.defaultScene, 0));
    if (chosen < scenes.size()) scene.name = short_name(scenes[chosen].name);
    if (const Status s = check_scene(scene); !s) return Error{fmt::format("{}: {}", document.name, s.error().message)};
    warn_of_totals(document, context.totals);
    loaded.warnings = std::move(document.warnings);
    return loaded;
}

}  // namespace
}  // namespace gltf

Result<LoadedScene> read_gltf(std::span<const std::byte> bytes, std::string_view name, const ResourceReader& resources,
                              const GltfReadOptions& options) {
    auto document = gltf::open_document(bytes, name, resources, options);
    if (!document) return document.error();
    return gltf::read(*document);
}

Result<LoadedScene> read_gltf(const std::filesystem::path& path, const GltfReadOptions& options) {
    const auto bytes = read_file(path, options.most_bytes);
    if (!bytes) return bytes.error();
    return read_gltf(*bytes, path.string(), gltf::files_in(path.parent_path()), options);
}

}  // namespace lobelia
