// Reads scenes from glTF 2.0 files (Khronos 2021).
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "io/counted.h"
#include "io/read_file.h"
#include "lobelia/gltf.h"
#include "scene/check_scene.h"
#include "scene/gltf/meshes.h"
#include "scene/world.h"

namespace lobelia {
namespace gltf {
namespace {

/// A mesh of the file as a node shows it: posed by a skin and morph targets, or unchanged.
struct MeshKey {
    std::size_t mesh = 0;
    std::optional<std::size_t> skin;
    std::vector<double> weights;
    auto operator<=>(const MeshKey&) const = default;
};

/// Copies of an object's name: its own, the world's, and those of the maps that find names of several.
constexpr std::size_t k_names = 4;

/// A bounding box, in double precision.
struct Box {
    std::array<double, 3> low{std::numeric_limits<double>::max(), std::numeric_limits<double>::max(),
                              std::numeric_limits<double>::max()};
    std::array<double, 3> high{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest(),
                               std::numeric_limits<double>::lowest()};

    void add(const std::array<double, 3>& p) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    [[nodiscard]] bool empty() const { return low[0] > high[0]; }
    [[nodiscard]] double center(std::size_t k) const { return 0.5 * (low[k] + high[k]); }
    [[nodiscard]] double diagonal() const { return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]); }
};

Box box_of(const Mesh& mesh) {
    Box box;
    for (const Vec3 p : mesh.positions)
        box.add({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    return box;
}

void add_corners(Box& target, const Box& box, const Placement& placement) {
    for (unsigned corner = 0; corner < 8; ++corner) {
        std::array<double, 3> moved{};
        for (std::size_t i = 0; i < 3; ++i) {
            moved[i] = placement.rows[i][3];
            for (std::size_t k = 0; k < 3; ++k)
                moved[i] += placement.rows[i][k] * ((corner >> k & 1u) != 0 ? box.high[k] : box.low[k]);
        }
        target.add(moved);
    }
}

/// Returns whether a box lies so far from zero, in metres and relative to its diagonal, that the scene should be moved:
/// its floats would be as far apart as those of a scene a thousand times as large.
bool is_far(const Box& box) {
    constexpr double k_metres = 1000, k_diagonals = 8;
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(box.center(k)));
    return largest > k_metres && largest > k_diagonals * box.diagonal();
}

/// Returns the distance between neighbouring floats at this distance from zero.
double float_step(double distance) {
    const auto x = static_cast<float>(distance);
    return static_cast<double>(std::nextafter(x, std::numeric_limits<float>::infinity()) - x);
}

class SceneReader {
  public:
    explicit SceneReader(Document& document) : document_(document) {}

    LoadedScene read() {
        // Read materials first: they decide which texture coordinates are needed.
        const UvSets uv_sets = read_materials(document_, scene_);
        tree_ = read_nodes(document_);
        MeshContext context{document_, uv_sets, static_cast<std::uint32_t>(scene_.materials.size()), false, {}};
        // Read skins last: they pose their meshes around the origin that the others give.
        read_meshes(context, false);
        choose_origin();
        read_meshes(context, true);
        if (context.uses_default) scene_.materials.emplace_back().name = "default";
        if (scene_.meshes.empty()) throw JsonRefusal(document_.json.file() + ": there are no triangles in the scene");
        for (const std::size_t node : tree_.shown) add_objects(node);
        name_objects();
        read_lights_and_cameras(document_, tree_, scene_);
        if (const auto chosen = default_scene(document_)) scene_.name = name_of(document_.scenes[*chosen]);
        if (const Status s = check_scene(scene_); !s)
            throw JsonRefusal(fmt::format("{}: {}", document_.json.file(), s.error().message));
        warn_of_totals(context.totals);
        LoadedScene loaded{std::move(scene_), std::move(document_.warnings)};
        constexpr std::size_t k_most_parts = 8;
        for (const JsonPlace& part : context.totals.without_uv)
            if (loaded.parts_without_lightmap_uv.size() < k_most_parts)
                loaded.parts_without_lightmap_uv.push_back(part.path());
        return loaded;
    }

  private:
    [[nodiscard]] std::optional<MeshKey> mesh_of(std::size_t node) {
        const JsonPlace& source = document_.nodes[node];
        const auto mesh = find_index(source, "mesh", document_.meshes.size());
        if (!mesh) return std::nullopt;
        MeshKey key{*mesh, find_index(source, "skin", document_.skins.size()),
                    morph_weights(source, document_.meshes[*mesh])};
        document_.work(source, 1 + key.weights.size());
        return key;
    }

    /// Reads the meshes that shown nodes use, in the file's order: those with skins, or those without.
    void read_meshes(MeshContext& context, bool skinned) {
        std::set<MeshKey> used;
        for (const std::size_t node : tree_.shown)
            if (auto key = mesh_of(node); key && key->skin.has_value() == skinned) used.insert(*std::move(key));
        std::size_t morphed = 0;
        for (const MeshKey& key : used) {
            Pose pose{key.weights, {}};
            morphed += !key.weights.empty();
            if (key.skin) pose.joints = joint_matrices(document_, tree_, *key.skin, scene_.origin);
            Mesh mesh = read_mesh(context, key.mesh, pose);
            if (mesh.triangles.empty()) continue;
            of_mesh_[key] = scene_.meshes.size();
            boxes_.push_back(box_of(mesh));
            warn_of_distance(document_.meshes[key.mesh], boxes_.back());
            scene_.meshes.push_back(std::move(mesh));
        }
        if (skinned && !used.empty())
            document_.warn("skins", fmt::format("{} read in their rest pose; the transforms of the skinned nodes are "
                                                "ignored",
                                                used.size()));
        if (morphed > 0)
            document_.warn("meshes", fmt::format("{} read with morph targets at their default weights", morphed));
    }

    void warn_of_distance(const JsonPlace& mesh, const Box& box) {
        double largest = 0;
        for (std::size_t k = 0; k < 3; ++k) largest = std::max({largest, -box.low[k], box.high[k]});
        constexpr double k_coarse = 1e-5;
        if (!is_far(box) || float_step(largest) < k_coarse * box.diagonal()) return;
        document_.warn(mesh, fmt::format("its positions lie {:.4g} m from its origin, where floats are {:.2g} m apart; "
                                         "place it by its node instead",
                                         largest, float_step(largest)));
    }

    /// Chooses an origin near the scene, if it lies far from the origin of its world.
    void choose_origin() {
        Box box;
        for (const std::size_t node : tree_.shown) {
            const auto key = mesh_of(node);
            if (!key) continue;
            const Placement& world = tree_.world_from_node[node];
            if (key->skin) {
                const JsonPlace joints = document_.skins[*key->skin].at("joints");
                document_.work(joints, joints.size());
                for (const JsonPlace& joint : joints.list(document_.nodes.size())) {
                    const auto& rows = tree_.world_from_node[index_below(joint, document_.nodes.size())].rows;
                    box.add({rows[0][3], rows[1][3], rows[2][3]});
                }
            } else if (const auto found = of_mesh_.find(*key); found != of_mesh_.end()) {
                for (const Placement& copy : instances_of(document_, document_.nodes[node]))
                    add_corners(box, boxes_[found->second], product(world, copy));
            }
        }
        if (box.empty() || !is_far(box)) return;
        double distance = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            // Leave axes along which the scene lies near zero unchanged.
            const double center = box.center(k);
            distance = std::max(distance, std::abs(center));
            scene_.origin[k] = std::abs(center) > box.diagonal() ? std::round(center) : 0;
        }
        document_.warn(
            "scene",
            fmt::format("it lies {:.6g} km from its origin, where floats are {:.2g} m apart; moved: "
                        "positions are relative to ({:.0f}, {:.0f}, {:.0f})",
                        distance / 1000, float_step(distance), scene_.origin[0], scene_.origin[1], scene_.origin[2]));
    }

    void add_objects(std::size_t node) {
        const auto key = mesh_of(node);
        const auto mesh = key ? of_mesh_.find(*key) : of_mesh_.end();
        if (mesh == of_mesh_.end()) return;

        // Count the objects before making them.
        const JsonPlace& source = document_.nodes[node];
        const GltfReadOptions& options = document_.options;
        const auto copies = instances_of(document_, source);
        if (copies.size() > options.most_objects - scene_.objects.size())
            source.refuse(fmt::format("more than {} objects", options.most_objects));
        const std::size_t each = scene_.meshes[mesh->second].triangles.size();
        if (copies.size() > (options.most_triangles - triangles_) / each)
            source.refuse(fmt::format("more than {} triangles in all objects", options.most_triangles));
        triangles_ += copies.size() * each;

        std::string name = name_of(source);
        if (name.empty()) name = scene_.meshes[mesh->second].name;
        if (name.empty()) name = fmt::format("node {}", node);
        document_.keep(source, copies.size(), sizeof(Object) + k_names * name.size() + each * k_bytes_per_triangle);
        for (std::size_t i = 0; i < copies.size(); ++i) {
            Object object;
            object.name = copies.size() == 1 ? name : fmt::format("{} {}", name, i);
            object.mesh = mesh->second;
            // Ignore the node's own transform: a skin's matrices map to the world.
            if (!key->skin)
                object.world_from_object = relative_to(scene_.origin, product(tree_.world_from_node[node], copies[i]));
            scene_.objects.push_back(std::move(object));
            node_of_object_.push_back(node);
        }
    }

    /// Renames objects that share a name to the path of names, and adds a number if that is shared, too.
    void name_objects() {
        const auto count_names = [&] {
            std::map<std::string, std::size_t> uses;
            for (const Object& object : scene_.objects) ++uses[object.name];
            return uses;
        };
        const auto shared = count_names();
        for (std::size_t i = 0; i < scene_.objects.size(); ++i)
            if (Object& object = scene_.objects[i]; shared.at(object.name) > 1)
                if (std::string path = name_path(document_, tree_, node_of_object_[i]); !path.empty()) {
                    const JsonPlace& source = document_.nodes[node_of_object_[i]];
                    document_.work(source, 1);
                    document_.keep(source, path.size(), k_names);
                    object.name = std::move(path);
                }
        auto taken = count_names();
        std::map<std::string, std::size_t> next;
        for (Object& object : scene_.objects) {
            if (taken.at(object.name) == 1) continue;
            document_.stop().check();
            const std::string base = object.name;
            std::size_t& number = next[base];
            do {
                object.name = fmt::format("{} #{}", base, ++number);
            } while (taken.contains(object.name));
            taken[object.name] = 1;
        }
    }

    void warn_of_totals(const MeshTotals& totals) {
        if (totals.no_area.count > 0)
            document_.warn("meshes", fmt::format("{} without area, the first is {}",
                                                 counted(totals.no_area.count, "triangle"), totals.no_area.first));
        if (totals.opposed_normals.count > 0)
            document_.warn(
                "meshes", fmt::format("{} with normals that point away from the front, the first is {}: light from the "
                                      "front does not reach them; reverse the normals or the winding",
                                      counted(totals.opposed_normals.count, "triangle"), totals.opposed_normals.first));
        if (totals.repaired_normals > 0)
            document_.warn("meshes", counted(totals.repaired_normals, "normal") +
                                         " without a direction; replaced by the mean of the triangles around them");
        if (document_.more_warnings > 0)
            document_.warnings.push_back("and " + counted(document_.more_warnings, "more warning"));
    }

    Document& document_;
    NodeTree tree_;
    Scene scene_;
    std::map<MeshKey, std::size_t> of_mesh_;  ///< index in the scene
    std::vector<Box> boxes_;                  ///< boxes of the scene's meshes
    std::vector<std::size_t> node_of_object_;
    std::size_t triangles_ = 0;
};

}  // namespace
}  // namespace gltf

Result<LoadedScene> read_gltf(std::span<const std::byte> bytes, std::string_view name, const ResourceReader& resources,
                              const GltfReadOptions& options) {
    return unless_stopped([&]() -> Result<LoadedScene> {
        try {
            gltf::Document document = gltf::open_document(bytes, std::string(name), resources, options);
            return gltf::SceneReader(document).read();
        } catch (const JsonRefusal& refusal) {
            return Error{refusal.what()};
        }
    });
}

Result<LoadedScene> read_gltf(const std::filesystem::path& path, const GltfReadOptions& options) {
    const auto bytes = read_file(path, options.most_bytes);
    if (!bytes) return bytes.error();
    return read_gltf(*bytes, path.string(), gltf::files_in(path.parent_path()), options);
}

}  // namespace lobelia
