// Meshes of a glTF file: all primitives of a mesh as triangles in one list.
#include "scene/gltf/meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scene/gltf/primitives.h"
#include "scene/world.h"

namespace lobelia::gltf {
namespace {

struct PrimitiveTriangles {
    std::vector<Triangle> triangles;  ///< indices of the block's vertices, later of the mesh's
    std::uint32_t material = 0;
};

/// Vertices shared by one or more primitives of a mesh. The used ones are consecutive in the mesh, from `first` on.
struct Block {
    JsonPlace primitive;  ///< the first primitive of the block
    JsonPlace attributes;
    std::size_t vertices = 0;
    std::vector<std::size_t> primitives;
    std::size_t first = 0;
    std::vector<std::uint32_t> used;  ///< indices in the file

    [[nodiscard]] bool has(const std::string& name) const { return !name.empty() && attributes.has(name.c_str()); }
};

bool is_finite(const std::array<float, 4>& v, std::size_t components) {
    return std::all_of(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(components),
                       [](float x) { return std::isfinite(x); });
}

Vec3 as_vec3(const std::array<float, 4>& v) { return {v[0], v[1], v[2]}; }

class MeshReader {
  public:
    MeshReader(MeshContext& context, std::size_t index, const Pose& pose)
        : context_(context), document_(context.document), source_(document_.meshes[index]), pose_(pose) {
        // Ignore a set that write_gltf added only to fill a gap: it holds no lightmap UVs.
        const std::size_t set = document_.options.uv_set;
        const auto extras = source_.find("extras");
        const bool fills_gap = set == 1 && extras && extras->is_object() && extras->has(k_no_lightmap);
        if (!fills_gap) lightmap_name_ = fmt::format("TEXCOORD_{}", set);
        for (std::size_t i = 0; i < 2; ++i)
            if (context.uv_sets.set[i]) uv_names_[i] = fmt::format("TEXCOORD_{}", *context.uv_sets.set[i]);
    }

    Mesh read() {
        mesh_.name = name_of(source_);
        const auto primitives = source_.at("primitives");
        for (const JsonPlace& primitive : primitives.list(primitives.size())) read_primitive(primitive);
        choose_attributes();
        number_vertices();
        for (const Block& block : blocks_) read_vertices(block);
        add_triangles();
        finish();
        return std::move(mesh_);
    }

  private:
    /// Returns whether a compressed primitive has plain data to fall back on.
    [[nodiscard]] bool has_position_data(const JsonPlace& attributes) const {
        const auto index = find_index(attributes, "POSITION", document_.accessors.size());
        return index && document_.accessors[*index].has("bufferView");
    }

    void read_primitive(const JsonPlace& primitive) {
        // Skip primitives that are not surfaces.
        const JsonPlace attributes = primitive.at("attributes");
        if (extension(primitive, "KHR_draco_mesh_compression") && !has_position_data(attributes))
            primitive.refuse(compressed("KHR_draco_mesh_compression"));
        if (!has_triangles(mode_of(primitive))) {
            document_.warn(primitive, "points or lines; left out");
            return;
        }
        if (!attributes.has("POSITION")) {
            document_.warn(primitive, "no POSITION; left out");
            return;
        }

        // Read its triangles, whose vertices it may share with other primitives.
        Block& block = block_of(primitive, attributes);
        auto triangles = read_triangles(document_, primitive, block.vertices,
                                        document_.options.most_triangles - context_.totals.triangles);
        context_.totals.triangles += triangles.size();
        block.primitives.push_back(primitives_.size());
        primitives_.push_back({std::move(triangles), material_of(primitive)});
    }

    /// Returns the block of all primitives with the same attributes and morph targets.
    Block& block_of(const JsonPlace& primitive, const JsonPlace& attributes) {
        std::vector<std::pair<std::string, std::size_t>> key;
        for (const auto& [name, index] : attributes.members()) key.emplace_back(name, whole(index));
        if (const auto targets = primitive.find("targets"))
            for (const JsonPlace& target : targets->list(targets->size())) {
                key.emplace_back("target", 0);
                for (const auto& [name, index] : target.members()) key.emplace_back(name, whole(index));
            }
        if (const auto found = known_.find(key); found != known_.end()) return blocks_[found->second];
        const JsonPlace index = attributes.at("POSITION");
        const Accessor positions(document_, index);
        if (positions.components() != 3) index.refuse("not VEC3");
        known_.emplace(std::move(key), blocks_.size());
        blocks_.push_back({primitive, attributes, positions.count(), {}, 0, {}});
        return blocks_.back();
    }

    std::uint32_t material_of(const JsonPlace& primitive) {
        if (const auto index = find_index(primitive, "material", document_.materials.size()))
            return static_cast<std::uint32_t>(*index);
        context_.uses_default = true;
        return context_.default_material;
    }

    /// Gives the mesh the attributes that any of its parts has; lightmap UVs only if all have them.
    void choose_attributes() {
        std::size_t with_lightmap = 0, with_triangles = 0;
        std::vector<JsonPlace> bare;
        for (const Block& block : blocks_) {
            const bool empty = std::all_of(block.primitives.begin(), block.primitives.end(),
                                           [&](std::size_t p) { return primitives_[p].triangles.empty(); });
            if (empty) continue;
            ++with_triangles;
            if (block.has(lightmap_name_)) {
                ++with_lightmap;
            } else {
                bare.push_back(block.primitive);
            }
            has_normals_ = has_normals_ || block.has("NORMAL");
            has_colors_ = has_colors_ || block.has("COLOR_0");
            for (std::size_t i = 0; i < 2; ++i) has_uv_[i] = has_uv_[i] || block.has(uv_names_[i]);
        }
        has_lightmap_uv_ = with_lightmap > 0 && with_lightmap == with_triangles;
        if (with_lightmap == 0 || has_lightmap_uv_) return;
        document_.warn(source_, fmt::format("only {} of {} parts have TEXCOORD_{}; it will not be baked", with_lightmap,
                                            with_triangles, document_.options.uv_set));
        auto& all = context_.totals.without_uv;
        all.insert(all.end(), bare.begin(), bare.end());
    }

    /// Keeps the used vertices, in the file's order, and numbers them.
    void number_vertices() {
        std::size_t next = 0;
        for (Block& block : blocks_) {
            block.first = next;
            if (has_normals_ && !block.has("NORMAL")) {
                separate_corners(block);
            } else {
                share_vertices(block);
            }
            next += block.used.size();
            const std::size_t left = 3 * document_.options.most_triangles - context_.totals.vertices;
            if (next > left || next > std::numeric_limits<std::uint32_t>::max())
                source_.refuse(fmt::format("{} vertices; the limit allows {} more", next, left));
        }
        context_.totals.vertices += next;
        document_.keep(source_, next, bytes_per_vertex());
        mesh_.positions.resize(next);
        if (has_normals_) mesh_.normals.resize(next);
        if (has_colors_) mesh_.colors.resize(next, {1, 1, 1, 1});
        if (has_lightmap_uv_) mesh_.lightmap_uv.resize(next);
        for (std::size_t i = 0; i < 2; ++i)
            if (has_uv_[i]) mesh_.uv[i].resize(next);
    }

    [[nodiscard]] std::size_t bytes_per_vertex() const {
        const auto part = [](bool has, std::size_t bytes) { return has ? bytes : 0; };
        return sizeof(Vec3) + part(has_normals_, sizeof(Vec3)) + part(has_colors_, 4 * sizeof(float)) +
               part(has_lightmap_uv_, sizeof(Vec2)) + part(has_uv_[0], sizeof(Vec2)) + part(has_uv_[1], sizeof(Vec2));
    }

    /// Gives each triangle its own vertices: the block has no normals and is flat, but other blocks of the mesh are
    /// smooth.
    void separate_corners(Block& block) {
        for (const std::size_t p : block.primitives)
            for (Triangle& triangle : primitives_[p].triangles)
                for (std::uint32_t& v : triangle) {
                    block.used.push_back(v);
                    v = static_cast<std::uint32_t>(block.first + block.used.size() - 1);
                }
    }

    void share_vertices(Block& block) {
        // Collect the used vertices by marking them, or by sorting if they are a small fraction.
        std::size_t corners = 0, end = 0;
        for (const std::size_t p : block.primitives) {
            corners += 3 * primitives_[p].triangles.size();
            for (const Triangle& t : primitives_[p].triangles)
                end = std::max(end, std::size_t{std::max({t[0], t[1], t[2]})} + 1);
        }
        const bool dense = end / 16 <= corners;
        std::vector<std::uint32_t> number(dense ? end : 0);
        for (const std::size_t p : block.primitives)
            for (const Triangle& triangle : primitives_[p].triangles)
                for (const std::uint32_t v : triangle) {
                    if (dense && number[v]++ > 0) continue;
                    block.used.push_back(v);
                }
        std::sort(block.used.begin(), block.used.end());
        block.used.erase(std::unique(block.used.begin(), block.used.end()), block.used.end());

        // Number the vertices.
        for (std::size_t i = 0; i < block.used.size() && dense; ++i)
            number[block.used[i]] = static_cast<std::uint32_t>(i);
        for (const std::size_t p : block.primitives)
            for (Triangle& triangle : primitives_[p].triangles)
                for (std::uint32_t& v : triangle) {
                    const std::size_t i =
                        dense ? number[v]
                              : static_cast<std::size_t>(std::lower_bound(block.used.begin(), block.used.end(), v) -
                                                         block.used.begin());
                    v = static_cast<std::uint32_t>(block.first + i);
                }
    }

    using Value = std::array<float, 4>;

    /// Reads one attribute of a block's used vertices, if it has it; `store` receives index, value and number of
    /// components.
    template <class Store>
    void read_attribute(const Block& block, const std::string& name, std::array<std::size_t, 2> components,
                        Store store) {
        if (!block.has(name)) return;
        const JsonPlace index = block.attributes.at(name.c_str());
        const Accessor accessor(document_, index);
        if (accessor.components() < components[0] || accessor.components() > components[1])
            index.refuse(fmt::format("{} components", accessor.components()));
        if (accessor.count() < block.vertices)
            index.refuse(fmt::format("{} elements for {} vertices", accessor.count(), block.vertices));
        // Normals that are not finite are repaired.
        const bool may_be_anything = name == "NORMAL";
        document_.for_each(index, block.used.size(), [&](std::size_t i) {
            const auto value = accessor[block.used[i]];
            if (!may_be_anything && !is_finite(value, accessor.components()))
                index.refuse(fmt::format("element {} is not finite", block.used[i]));
            store(block.first + i, value, accessor.components());
        });
    }

    void read_vertices(const Block& block) {
        if (block.used.empty()) return;
        read_attribute(block, "POSITION", {3, 3},
                       [&](std::size_t v, const Value& value, std::size_t) { mesh_.positions[v] = as_vec3(value); });
        read_attribute(block, "NORMAL", {3, 3},
                       [&](std::size_t v, const Value& value, std::size_t) { mesh_.normals[v] = as_vec3(value); });
        read_attribute(block, "COLOR_0", {3, 4}, [&](std::size_t v, const Value& value, std::size_t components) {
            for (std::size_t k = 0; k < components; ++k) mesh_.colors[v][k] = std::clamp(value[k], 0.0f, 1.0f);
        });
        for (std::size_t i = 0; i < 2; ++i) read_uv(block, uv_names_[i], mesh_.uv[i]);
        if (has_lightmap_uv_) read_uv(block, lightmap_name_, mesh_.lightmap_uv);
        const auto mirrored =
            apply_pose(document_, pose_, block.primitive, {block.first, block.used, block.vertices}, mesh_);
        for (const std::size_t p : block.primitives)
            for (Triangle& t : primitives_[p].triangles)
                if (!mirrored.empty() && mirrored[t[0] - block.first]) std::swap(t[1], t[2]);
    }

    void read_uv(const Block& block, const std::string& name, std::vector<Vec2>& target) {
        read_attribute(block, name, {2, 2}, [&](std::size_t v, const Value& value, std::size_t) {
            target[v] = {value[0], value[1]};
        });
    }

    void add_triangles() {
        std::size_t count = 0;
        for (const PrimitiveTriangles& primitive : primitives_) count += primitive.triangles.size();
        mesh_.triangles.reserve(count);
        mesh_.materials.reserve(count);
        for (const PrimitiveTriangles& primitive : primitives_) {
            mesh_.triangles.insert(mesh_.triangles.end(), primitive.triangles.begin(), primitive.triangles.end());
            mesh_.materials.insert(mesh_.materials.end(), primitive.triangles.size(), primitive.material);
        }
    }

    void finish() {
        const std::vector<bool> repaired = repair_normals(mesh_);
        for (const Block& block : blocks_)
            for (std::size_t i = 0; i < block.used.size() && !repaired.empty() && block.has("NORMAL"); ++i)
                context_.totals.repaired_normals += repaired[block.first + i];
        document_.for_each(source_, mesh_.triangles.size(), [&](std::size_t t) {
            if (area_vector(mesh_, t) == Vec3{}) {
                count(context_.totals.no_area, t);
            } else if (!mesh_.normals.empty() && opposes_winding(mesh_, t)) {
                count(context_.totals.opposed_normals, t);
            }
        });
    }

    void count(Tally& tally, std::size_t triangle) const {
        if (tally.count++ == 0) tally.first = fmt::format("{}, triangle {}", source_.path(), triangle);
    }

    MeshContext& context_;
    Document& document_;
    JsonPlace source_;
    const Pose& pose_;
    Mesh mesh_;
    std::vector<PrimitiveTriangles> primitives_;
    std::vector<Block> blocks_;
    std::map<std::vector<std::pair<std::string, std::size_t>>, std::size_t> known_;
    std::string lightmap_name_;
    std::array<std::string, 2> uv_names_;
    bool has_normals_ = false, has_colors_ = false, has_lightmap_uv_ = false;
    std::array<bool, 2> has_uv_{};
};

}  // namespace

Mesh read_mesh(MeshContext& context, std::size_t index, const Pose& pose) {
    return MeshReader(context, index, pose).read();
}

}  // namespace lobelia::gltf
