// The node hierarchy of a glTF file, flattened.
#include "scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include "scene/gltf_accessors.h"

namespace lobelia::gltf {
namespace {

constexpr std::size_t k_none = ~std::size_t{0};

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool is_finite(const Transform& t) {
    return is_finite(t.rows[0]) && is_finite(t.rows[1]) && is_finite(t.rows[2]) && is_finite(t.translation);
}

/// Translation, then rotation by a quaternion (x, y, z, w), then scale.
struct Trs {
    std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
    std::array<double, 4> rotation{0, 0, 0, 1};
};

Transform transform_from(const Trs& trs) {
    auto [x, y, z, w] = trs.rotation;
    const double l = std::sqrt(x * x + y * y + z * z + w * w);
    if (l > 0) x /= l, y /= l, z /= l, w /= l;
    const std::array<std::array<double, 3>, 3> r{{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                                                  {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                                                  {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    Transform t;
    for (std::size_t i = 0; i < 3; ++i)
        t.rows[i] = {static_cast<float>(r[i][0] * trs.scale[0]), static_cast<float>(r[i][1] * trs.scale[1]),
                     static_cast<float>(r[i][2] * trs.scale[2])};
    t.translation = {static_cast<float>(trs.translation[0]), static_cast<float>(trs.translation[1]),
                     static_cast<float>(trs.translation[2])};
    return t;
}

}  // namespace

Transform product(const Transform& a, const Transform& b) {
    const Vec3 bx{b.rows[0].x, b.rows[1].x, b.rows[2].x}, by{b.rows[0].y, b.rows[1].y, b.rows[2].y},
        bz{b.rows[0].z, b.rows[1].z, b.rows[2].z};
    Transform t;
    for (std::size_t i = 0; i < 3; ++i) t.rows[i] = {dot(a.rows[i], bx), dot(a.rows[i], by), dot(a.rows[i], bz)};
    t.translation = transform_point(a, b.translation);
    return t;
}

namespace {

template <std::size_t N>
bool copy(const std::vector<double>& source, std::array<double, N>& target) {
    if (source.size() == N) std::copy(source.begin(), source.end(), target.begin());
    return source.size() == N || source.empty();
}

Result<Transform> local_transform(const Document& document, std::size_t index) {
    const tinygltf::Node& node = document.model.nodes[index];
    const std::string place = fmt::format("nodes[{}]", index);
    Transform t;
    if (!node.matrix.empty()) {
        // Column by column.
        std::array<double, 16> m{};
        if (!copy(node.matrix, m)) return document.error(place + ".matrix", "not 16 numbers");
        const auto at = [&](std::size_t row, std::size_t column) { return static_cast<float>(m[4 * column + row]); };
        for (std::size_t i = 0; i < 3; ++i) t.rows[i] = {at(i, 0), at(i, 1), at(i, 2)};
        t.translation = {at(0, 3), at(1, 3), at(2, 3)};
    } else {
        Trs trs;
        if (!copy(node.translation, trs.translation)) return document.error(place + ".translation", "not 3 numbers");
        if (!copy(node.rotation, trs.rotation)) return document.error(place + ".rotation", "not 4 numbers");
        if (!copy(node.scale, trs.scale)) return document.error(place + ".scale", "not 3 numbers");
        t = transform_from(trs);
    }
    if (!is_finite(t)) return document.error(place, "its transform is not finite");
    return t;
}

/// The parent of each node, k_none for roots.
Result<std::vector<std::size_t>> parents(const Document& document) {
    const auto& nodes = document.model.nodes;
    std::vector<std::size_t> parent(nodes.size(), k_none);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            if (child < 0 || static_cast<std::size_t>(child) >= nodes.size())
                return document.error(fmt::format("nodes[{}].children", i),
                                      fmt::format("{} of {}", child, nodes.size()));
            std::size_t& p = parent[static_cast<std::size_t>(child)];
            if (p != k_none)
                return document.error(fmt::format("nodes[{}]", child),
                                      p == i ? fmt::format("twice a child of nodes[{}]", i)
                                             : fmt::format("it has several parents, nodes[{}] and nodes[{}]", p, i));
            p = i;
        }

    // With one parent each, what is not below a root goes in circles.
    std::vector<std::size_t> stack;
    std::size_t reached = 0;
    std::vector<bool> seen(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] == k_none) stack.push_back(i);
    while (!stack.empty()) {
        const std::size_t i = stack.back();
        stack.pop_back();
        seen[i] = true;
        ++reached;
        for (const int child : nodes[i].children) stack.push_back(static_cast<std::size_t>(child));
    }
    if (reached < nodes.size())
        return document.error(fmt::format("nodes[{}]", std::find(seen.begin(), seen.end(), false) - seen.begin()),
                              "it is among its own ancestors");
    return parent;
}

/// The nodes from which the scene hangs.
Result<std::vector<std::size_t>> roots(Document& document, const std::vector<std::size_t>& parent) {
    const auto& model = document.model;
    std::vector<std::size_t> result;
    if (model.scenes.empty()) {
        for (std::size_t i = 0; i < parent.size(); ++i)
            if (parent[i] == k_none) result.push_back(i);
        return result;
    }
    const int chosen = std::max(model.defaultScene, 0);
    if (static_cast<std::size_t>(chosen) >= model.scenes.size())
        return document.error("scene", fmt::format("{} of {}", chosen, model.scenes.size()));
    if (model.scenes.size() > 1)
        document.warn("scenes", fmt::format("{} scenes; only scenes[{}] is read", model.scenes.size(), chosen));
    std::vector<bool> listed(parent.size());
    for (const int node : model.scenes[static_cast<std::size_t>(chosen)].nodes) {
        const std::string place = fmt::format("scenes[{}].nodes", chosen);
        if (node < 0 || static_cast<std::size_t>(node) >= parent.size())
            return document.error(place, fmt::format("{} of {}", node, parent.size()));
        const auto n = static_cast<std::size_t>(node);
        if (parent[n] != k_none)
            return document.error(place, fmt::format("nodes[{}] is no root but a child of nodes[{}]", n, parent[n]));
        if (listed[n]) return document.error(place, fmt::format("nodes[{}] stands there twice", n));
        listed[n] = true;
        result.push_back(n);
    }
    return result;
}

}  // namespace

Result<std::vector<PlacedNode>> placed_nodes(Document& document) {
    const auto parent = parents(document);
    if (!parent) return parent.error();
    const auto first = roots(document, *parent);
    if (!first) return first.error();

    // Go down depth first, without recursion: hierarchies may be as deep as they like.
    std::vector<PlacedNode> placed, stack;
    for (auto root = first->rbegin(); root != first->rend(); ++root) stack.push_back({*root, {}});
    while (!stack.empty()) {
        PlacedNode current = stack.back();
        stack.pop_back();
        const auto local = local_transform(document, current.node);
        if (!local) return local.error();
        current.world_from_node = product(current.world_from_node, *local);
        if (!is_finite(current.world_from_node))
            return document.error(fmt::format("nodes[{}]", current.node), "its place in the world is not finite");
        const auto& children = document.model.nodes[current.node].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            stack.push_back({static_cast<std::size_t>(*child), current.world_from_node});
        placed.push_back(current);
    }
    return placed;
}

Result<std::vector<Transform>> instances_of(Document& document, std::size_t node) {
    const auto* value = extension(document.model.nodes[node].extensions, "EXT_mesh_gpu_instancing");
    if (value == nullptr) return std::vector<Transform>(1);
    const std::string place = fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing.attributes", node);
    const tinygltf::Value& attributes = value->Get("attributes");

    // Open what is there of translation, rotation and scale; all have one element for each copy.
    std::array<std::optional<Accessor>, 3> accessors;
    constexpr std::array<const char*, 3> k_names{"TRANSLATION", "ROTATION", "SCALE"};
    std::optional<std::size_t> count;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto index = checked_index(document, attributes, k_names[i], document.model.accessors.size(), place);
        if (!index) return index.error();
        if (!*index) continue;
        auto accessor = Accessor::open(document, static_cast<int>(**index), fmt::format("{}.{}", place, k_names[i]));
        if (!accessor) return accessor.error();
        if (accessor->components() != (i == 1 ? 4u : 3u) || (count && *count != accessor->count()))
            return document.error(fmt::format("{}.{}", place, k_names[i]), "not of the type and number of the others");
        count = accessor->count();
        accessors[i] = *std::move(accessor);
    }
    if (!count) return std::vector<Transform>(1);
    if (*count > document.options.most_objects)
        return document.error(place,
                              fmt::format("{} copies; at most {} are read", *count, document.options.most_objects));

    std::vector<Transform> copies;
    copies.reserve(*count);
    for (std::size_t i = 0; i < *count; ++i) {
        Trs trs;
        if (accessors[0]) std::copy_n((*accessors[0])[i].begin(), 3, trs.translation.begin());
        if (accessors[1]) std::copy_n((*accessors[1])[i].begin(), 4, trs.rotation.begin());
        if (accessors[2]) std::copy_n((*accessors[2])[i].begin(), 3, trs.scale.begin());
        copies.push_back(transform_from(trs));
        if (!is_finite(copies.back())) return document.error(place, fmt::format("copy {} is not finite", i));
    }
    return copies;
}

}  // namespace lobelia::gltf
