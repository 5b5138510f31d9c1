// Meshes of a glTF file: all primitives of one as triangles in one list.
#include "scene/gltf_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scene/gltf_json.h"
#include "scene/gltf_normals.h"
#include "scene/gltf_triangles.h"

namespace lobelia::gltf {
namespace {

/// Accessors of a primitive's attributes that are read, -1 where there is none. Primitives with the same ones share
/// their vertices.
struct Attributes {
    int position = -1, normal = -1, color = -1, lightmap_uv = -1;
    std::array<int, 2> uv{-1, -1};
    auto operator<=>(const Attributes&) const = default;
};

struct PrimitiveTriangles {
    std::vector<Triangle> triangles;  ///< over the block's vertices, then over the mesh's
    std::uint32_t material = 0;
};

/// Vertices that one or more primitives of a mesh share. Those in use lie together in the mesh, from `first` on.
struct Block {
    Attributes attributes;
    std::string place;  ///< of the first such primitive
    std::size_t vertices = 0;
    std::vector<std::size_t> primitives;
    std::size_t first = 0;
    std::vector<std::uint32_t> used;  ///< in the file's numbers
};

bool is_finite(const std::array<float, 4>& v, std::size_t components) {
    return std::all_of(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(components),
                       [](float x) { return std::isfinite(x); });
}

Vec3 as_vec3(const std::array<float, 4>& v) { return {v[0], v[1], v[2]}; }

class MeshReader {
  public:
    MeshReader(MeshContext& context, std::size_t index)
        : context_(context),
          document_(context.document),
          source_(document_.model.meshes[index]),
          place_(fmt::format("meshes[{}]", index)) {}

    Result<Mesh> read() {
        mesh_.name = short_name(source_.name);
        for (std::size_t p = 0; p < source_.primitives.size(); ++p)
            if (const Status s = read_primitive(p); !s) return s.error();
        choose_attributes();
        if (const Status s = number_vertices(); !s) return s.error();
        for (const Block& block : blocks_)
            if (const Status s = read_vertices(block); !s) return s.error();
        add_triangles();
        finish();
        return std::move(mesh_);
    }

  private:
    [[nodiscard]] Attributes attributes_of(const tinygltf::Primitive& primitive) const {
        const auto find = [&](const std::string& name) {
            const auto found = primitive.attributes.find(name);
            return found == primitive.attributes.end() ? -1 : found->second;
        };
        Attributes attributes{
            find("POSITION"),
            find("NORMAL"),
            find("COLOR_0"),
            fills_gap(document_.options.uv_set) ? -1 : find(fmt::format("TEXCOORD_{}", document_.options.uv_set)),
            {-1, -1}};
        for (std::size_t i = 0; i < 2; ++i)
            if (context_.uv_sets.set[i]) attributes.uv[i] = find(fmt::format("TEXCOORD_{}", *context_.uv_sets.set[i]));
        return attributes;
    }

    /// Whether a set is one that our own writer had to put there.
    [[nodiscard]] bool fills_gap(std::size_t set) const { return set == 1 && source_.extras.Has(k_no_lightmap); }

    /// Compressed primitives may bring plain data, too, to fall back on.
    [[nodiscard]] bool has_position_data(const tinygltf::Primitive& primitive) const {
        const int position = attributes_of(primitive).position;
        const auto& accessors = document_.model.accessors;
        return position >= 0 && static_cast<std::size_t>(position) < accessors.size() &&
               accessors[static_cast<std::size_t>(position)].bufferView >= 0;
    }

    Status read_primitive(std::size_t p) {
        // Leave out what is no surface.
        const tinygltf::Primitive& primitive = source_.primitives[p];
        const std::string place = fmt::format("{}.primitives[{}]", place_, p);
        if (extension(primitive.extensions, "KHR_draco_mesh_compression") && !has_position_data(primitive))
            return document_.error(place, compressed("KHR_draco_mesh_compression"));
        if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            return document_.error(place + ".mode", fmt::format("{}", primitive.mode));
        if (!has_triangles(primitive.mode)) {
            document_.warn(place, "points or lines; left out");
            return Done{};
        }
        if (!primitive.targets.empty()) document_.warn(place, "its morph targets are not read");

        // Read its triangles, over the vertices that it may share with others.
        const Attributes attributes = attributes_of(primitive);
        if (attributes.position < 0) return document_.error(place + ".attributes.POSITION", "missing");
        const auto block = block_of(attributes, place);
        if (!block) return block.error();
        auto triangles = read_triangles(document_, primitive, blocks_[*block].vertices,
                                        document_.options.most_triangles - context_.totals.triangles, place);
        if (!triangles) return triangles.error();
        context_.totals.triangles += triangles->size();
        const auto material = material_of(primitive, place);
        if (!material) return material.error();
        blocks_[*block].primitives.push_back(primitives_.size());
        primitives_.push_back({*std::move(triangles), *material});
        return Done{};
    }

    Result<std::size_t> block_of(const Attributes& attributes, const std::string& place) {
        if (const auto found = known_.find(attributes); found != known_.end()) return found->second;
        const auto positions = Accessor::open(document_, attributes.position, place + ".attributes.POSITION");
        if (!positions) return positions.error();
        if (positions->components() != 3) return document_.error(place + ".attributes.POSITION", "not VEC3");
        known_.emplace(attributes, blocks_.size());
        blocks_.push_back({attributes, place, positions->count(), {}, 0, {}});
        return blocks_.size() - 1;
    }

    Result<std::uint32_t> material_of(const tinygltf::Primitive& primitive, const std::string& place) {
        if (primitive.material < 0) {
            context_.uses_default = true;
            return context_.default_material;
        }
        if (static_cast<std::size_t>(primitive.material) >= document_.model.materials.size())
            return document_.error(place + ".material",
                                   fmt::format("{} of {}", primitive.material, document_.model.materials.size()));
        return static_cast<std::uint32_t>(primitive.material);
    }

    /// The mesh has what any of its parts has; but lightmap UVs only if all have them.
    void choose_attributes() {
        std::size_t with_lightmap = 0, with_triangles = 0;
        for (const Block& block : blocks_) {
            const bool empty = std::all_of(block.primitives.begin(), block.primitives.end(),
                                           [&](std::size_t p) { return primitives_[p].triangles.empty(); });
            if (empty) continue;
            ++with_triangles;
            with_lightmap += block.attributes.lightmap_uv >= 0;
            has_normals_ = has_normals_ || block.attributes.normal >= 0;
            has_colors_ = has_colors_ || block.attributes.color >= 0;
            for (std::size_t i = 0; i < 2; ++i) has_uv_[i] = has_uv_[i] || block.attributes.uv[i] >= 0;
        }
        has_lightmap_uv_ = with_lightmap > 0 && with_lightmap == with_triangles;
        if (with_lightmap > 0 && !has_lightmap_uv_)
            document_.warn(place_, fmt::format("only {} of {} parts have TEXCOORD_{}; it will not be baked",
                                               with_lightmap, with_triangles, document_.options.uv_set));
    }

    /// Keeps the vertices that some triangle uses, in the file's order, and numbers them.
    Status number_vertices() {
        std::size_t next = 0;
        for (Block& block : blocks_) {
            block.first = next;
            if (has_normals_ && block.attributes.normal < 0) {
                separate_corners(block);
            } else {
                share_vertices(block);
            }
            next += block.used.size();
            const std::size_t left = 3 * document_.options.most_triangles - context_.totals.vertices;
            if (next > left || next > std::numeric_limits<std::uint32_t>::max())
                return document_.error(place_, fmt::format("{} vertices; at most {} are left to be read", next, left));
        }
        context_.totals.vertices += next;
        mesh_.positions.resize(next);
        if (has_normals_) mesh_.normals.resize(next);
        if (has_colors_) mesh_.colors.resize(next, {1, 1, 1, 1});
        if (has_lightmap_uv_) mesh_.lightmap_uv.resize(next);
        for (std::size_t i = 0; i < 2; ++i)
            if (has_uv_[i]) mesh_.uv[i].resize(next);
        return Done{};
    }

    /// Each triangle has vertices of its own: it is flat, and others of the mesh are not.
    void separate_corners(Block& block) {
        for (const std::size_t p : block.primitives)
            for (Triangle& triangle : primitives_[p].triangles)
                for (std::uint32_t& v : triangle) {
                    block.used.push_back(v);
                    v = static_cast<std::uint32_t>(block.first + block.used.size() - 1);
                }
    }

    void share_vertices(Block& block) {
        // List the vertices in use by marking them, or by sorting where few of many are.
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

        // Number them.
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

    /// Reads one attribute of a block's used vertices; `store` takes index and value. Values must be finite.
    template <class Store>
    Status read_attribute(const Block& block, int index, std::string_view name, std::array<std::size_t, 2> components,
                          Store store) {
        const std::string place = fmt::format("{}.attributes.{}", block.place, name);
        const auto accessor = Accessor::open(document_, index, place);
        if (!accessor) return accessor.error();
        if (accessor->components() < components[0] || accessor->components() > components[1])
            return document_.error(place, fmt::format("{} components", accessor->components()));
        if (accessor->count() < block.vertices)
            return document_.error(place,
                                   fmt::format("{} elements for {} vertices", accessor->count(), block.vertices));
        const bool may_be_anything = name == "NORMAL";
        for (std::size_t i = 0; i < block.used.size(); ++i) {
            const auto value = (*accessor)[block.used[i]];
            if (!may_be_anything && !is_finite(value, accessor->components()))
                return document_.error(place, fmt::format("element {} is not finite", block.used[i]));
            store(block.first + i, value, accessor->components());
        }
        return Done{};
    }

    Status read_vertices(const Block& block) {
        using Value = std::array<float, 4>;
        const Attributes& a = block.attributes;
        if (block.used.empty()) return Done{};
        if (const Status s = read_attribute(
                block, a.position, "POSITION", {3, 3},
                [&](std::size_t v, const Value& value, std::size_t) { mesh_.positions[v] = as_vec3(value); });
            !s)
            return s;
        if (a.normal >= 0)
            if (const Status s = read_attribute(
                    block, a.normal, "NORMAL", {3, 3},
                    [&](std::size_t v, const Value& value, std::size_t) { mesh_.normals[v] = as_vec3(value); });
                !s)
                return s;
        if (a.color >= 0)
            if (const Status s = read_attribute(block, a.color, "COLOR_0", {3, 4},
                                                [&](std::size_t v, const Value& value, std::size_t components) {
                                                    for (std::size_t k = 0; k < components; ++k)
                                                        mesh_.colors[v][k] = std::clamp(value[k], 0.0f, 1.0f);
                                                });
                !s)
                return s;
        for (std::size_t i = 0; i < 2; ++i)
            if (a.uv[i] >= 0)
                if (const Status s = read_uv(block, a.uv[i], *context_.uv_sets.set[i], mesh_.uv[i]); !s) return s;
        if (has_lightmap_uv_) return read_uv(block, a.lightmap_uv, document_.options.uv_set, mesh_.lightmap_uv);
        return Done{};
    }

    Status read_uv(const Block& block, int accessor, std::size_t set, std::vector<Vec2>& target) {
        return read_attribute(block, accessor, fmt::format("TEXCOORD_{}", set), {2, 2},
                              [&](std::size_t v, const std::array<float, 4>& value, std::size_t) {
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
            for (std::size_t i = 0; i < block.used.size() && !repaired.empty() && block.attributes.normal >= 0; ++i)
                context_.totals.repaired_normals += repaired[block.first + i];
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (area_vector(mesh_, t) != Vec3{}) continue;
            if (context_.totals.no_area++ == 0)
                context_.totals.first_no_area = fmt::format("{}, triangle {}", place_, t);
        }
    }

    MeshContext& context_;
    Document& document_;
    const tinygltf::Mesh& source_;
    std::string place_;
    Mesh mesh_;
    std::vector<PrimitiveTriangles> primitives_;
    std::vector<Block> blocks_;
    std::map<Attributes, std::size_t> known_;
    bool has_normals_ = false, has_colors_ = false, has_lightmap_uv_ = false;
    std::array<bool, 2> has_uv_{};
};

}  // namespace

Result<Mesh> read_mesh(MeshContext& context, std::size_t index) { return MeshReader(context, index).read(); }

}  // namespace lobelia::gltf
