// The node hierarchy of a glTF file, flattened.
#include "scene/gltf/nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/gltf/accessors.h"

namespace lobelia::gltf {
namespace {

bool fits_float(const Placement& placement) {
    for (const auto& row : placement.rows)
        for (const double x : row)
            if (!(std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
    return true;
}

/// A transform: translation, then rotation by a quaternion (x, y, z, w), then scale.
struct Trs {
    std::array<double, 3> translation{0, 0, 0}, scale{1, 1, 1};
    std::array<double, 4> rotation{0, 0, 0, 1};
};

Placement placement_from(const Trs& trs) {
    auto [x, y, z, w] = trs.rotation;
    const double l = std::sqrt(x * x + y * y + z * z + w * w);
    if (l > 0) x /= l, y /= l, z /= l, w /= l;
    const std::array<std::array<double, 3>, 3> r{{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                                                  {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                                                  {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
    Placement result;
    for (std::size_t i = 0; i < 3; ++i)
        result.rows[i] = {r[i][0] * trs.scale[0], r[i][1] * trs.scale[1], r[i][2] * trs.scale[2], trs.translation[i]};
    return result;
}

Placement local_placement(const JsonPlace& node) {
    if (const auto matrix = node.find("matrix")) {
        // Read it column by column.
        std::array<double, 16> m{};
        matrix->numbers(m);
        Placement result;
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 4; ++column) result.rows[row][column] = m[4 * column + row];
        return result;
    }
    Trs trs;
    if (const auto found = node.find("translation")) found->numbers(trs.translation);
    if (const auto found = node.find("rotation")) found->numbers(trs.rotation);
    if (const auto found = node.find("scale")) found->numbers(trs.scale);
    return placement_from(trs);
}

std::vector<std::vector<std::size_t>> read_children(const Document& document) {
    std::vector<std::vector<std::size_t>> children(document.nodes.size());
    for (std::size_t i = 0; i < children.size(); ++i)
        if (const auto list = document.nodes[i].find("children"))
            for (const JsonPlace& child : list->list(children.size())) {
                const std::size_t c = whole(child);
                if (c >= children.size()) list->refuse(fmt::format("{} of {}", c, children.size()));
                children[i].push_back(c);
            }
    return children;
}

std::vector<std::optional<std::size_t>> find_parents(const Document& document,
                                                     const std::vector<std::vector<std::size_t>>& children) {
    std::vector<std::optional<std::size_t>> parent(children.size());
    for (std::size_t i = 0; i < children.size(); ++i)
        for (const std::size_t child : children[i]) {
            auto& p = parent[child];
            if (p)
                document.nodes[child].refuse(
                    *p == i ? fmt::format("twice a child of nodes[{}]", i)
                            : fmt::format("it has several parents, nodes[{}] and nodes[{}]", *p, i));
            p = i;
        }
    return parent;
}

/// Computes the placement of every node, depth first without recursion: hierarchies may be of any depth. `shown`
/// receives the visible nodes below `roots`.
class TreeWalk {
  public:
    TreeWalk(const Document& document, const std::vector<std::vector<std::size_t>>& children, NodeTree& tree)
        : document_(document), children_(children), tree_(tree), reached_(children.size()) {}

    void walk(std::size_t root, bool in_scene) {
        std::vector<Entry> stack{{root, in_scene}};
        while (!stack.empty()) {
            auto [node, shown] = stack.back();
            stack.pop_back();
            shown = place(node, shown);
            for (auto child = children_[node].rbegin(); child != children_[node].rend(); ++child)
                stack.push_back({*child, shown});
        }
    }
    [[nodiscard]] const std::vector<bool>& reached() const { return reached_; }
    [[nodiscard]] std::size_t hidden() const { return hidden_; }

  private:
    struct Entry {
        std::size_t node;
        bool shown;
    };

    bool place(std::size_t node, bool shown) {
        const JsonPlace& source = document_.nodes[node];
        reached_[node] = true;
        Placement& placement = tree_.world_from_node[node];
        placement = local_placement(source);
        if (!fits_float(placement)) source.refuse("its transform is not finite");
        if (const auto parent = tree_.parent[node]) placement = product(tree_.world_from_node[*parent], placement);
        if (!shown) return false;
        if (!fits_float(placement)) source.refuse("its place in the world is not finite");
        const auto visibility = extension(source, "KHR_node_visibility");
        const auto visible = visibility ? visibility->find("visible") : std::nullopt;
        if (visible && !visible->flag()) {
            ++hidden_;
            return false;
        }
        tree_.shown.push_back(node);
        return true;
    }

    const Document& document_;
    const std::vector<std::vector<std::size_t>>& children_;
    NodeTree& tree_;
    std::vector<bool> reached_;
    std::size_t hidden_ = 0;
};

/// Returns the root nodes of the scene.
std::vector<std::size_t> find_roots(Document& document, const NodeTree& tree) {
    std::vector<std::size_t> roots;
    const auto chosen = default_scene(document);
    if (!chosen) {
        for (std::size_t i = 0; i < tree.parent.size(); ++i)
            if (!tree.parent[i]) roots.push_back(i);
        return roots;
    }
    if (document.scenes.size() > 1)
        document.warn("scenes", fmt::format("{} scenes; only scenes[{}] is read", document.scenes.size(), *chosen));
    const auto list = document.scenes[*chosen].find("nodes");
    if (!list) return roots;
    std::vector<bool> listed(tree.parent.size());
    for (const JsonPlace& entry : list->list(list->size())) {
        const std::size_t n = whole(entry);
        if (n >= listed.size()) list->refuse(fmt::format("{} of {}", n, listed.size()));
        if (tree.parent[n])
            list->refuse(fmt::format("nodes[{}] is not a root: it is a child of nodes[{}]", n, *tree.parent[n]));
        if (listed[n]) list->refuse(fmt::format("nodes[{}] is listed twice", n));
        listed[n] = true;
        roots.push_back(n);
    }
    return roots;
}

}  // namespace

Placement product(const Placement& a, const Placement& b) {
    Placement result;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 4; ++k)
            result.rows[i][k] = a.rows[i][0] * b.rows[0][k] + a.rows[i][1] * b.rows[1][k] +
                                a.rows[i][2] * b.rows[2][k] + (k == 3 ? a.rows[i][3] : 0);
    return result;
}

Transform relative_to(const std::array<double, 3>& origin, const Placement& placement) {
    Transform result;
    std::array<float, 3> translation{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = placement.rows[i];
        result.rows[i] = {static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2])};
        translation[i] = static_cast<float>(row[3] - origin[i]);
    }
    result.translation = {translation[0], translation[1], translation[2]};
    return result;
}

std::optional<std::size_t> default_scene(const Document& document) {
    if (document.scenes.empty()) return std::nullopt;
    return find_index(JsonPlace(document.json), "scene", document.scenes.size()).value_or(0);
}

NodeTree read_nodes(Document& document) {
    NodeTree tree;
    const auto children = read_children(document);
    tree.parent = find_parents(document, children);
    tree.world_from_node.resize(children.size());

    // Place the scene's nodes in its order, then all others, which skins may refer to.
    TreeWalk walk(document, children, tree);
    for (const std::size_t root : find_roots(document, tree)) walk.walk(root, true);
    for (std::size_t i = 0; i < children.size(); ++i)
        if (!tree.parent[i] && !walk.reached()[i]) walk.walk(i, false);

    // As each node has at most one parent, a node that is not below a root is in a cycle.
    const auto lost = std::find(walk.reached().begin(), walk.reached().end(), false);
    if (lost != walk.reached().end())
        document.nodes[static_cast<std::size_t>(lost - walk.reached().begin())].refuse(
            "it is one of its own ancestors");
    if (walk.hidden() > 0)
        document.warn("nodes",
                      fmt::format("{} hidden by KHR_node_visibility, with all below; left out", walk.hidden()));
    return tree;
}

std::vector<Placement> instances_of(Document& document, const JsonPlace& node) {
    const auto instancing = extension(node, "EXT_mesh_gpu_instancing");
    if (!instancing) return std::vector<Placement>(1);
    const JsonPlace attributes = instancing->at("attributes");

    // Open translation, rotation and scale; all have one element per copy.
    std::array<std::optional<Accessor>, 3> accessors;
    constexpr std::array<const char*, 3> k_names{"TRANSLATION", "ROTATION", "SCALE"};
    std::optional<std::size_t> count;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto index = attributes.find(k_names[i]);
        if (!index) continue;
        const Accessor& accessor = accessors[i].emplace(document, *index);
        if (accessor.components() != (i == 1 ? 4u : 3u) || (count && *count != accessor.count()))
            index->refuse("its type or count differs from the others");
        count = accessor.count();
    }
    if (!count) return std::vector<Placement>(1);
    if (*count > document.options.most_objects)
        attributes.refuse(fmt::format("{} copies; at most {} are read", *count, document.options.most_objects));

    std::vector<Placement> copies;
    copies.reserve(*count);
    document.for_each(attributes, *count, [&](std::size_t i) {
        Trs trs;
        if (accessors[0]) std::copy_n((*accessors[0])[i].begin(), 3, trs.translation.begin());
        if (accessors[1]) std::copy_n((*accessors[1])[i].begin(), 4, trs.rotation.begin());
        if (accessors[2]) std::copy_n((*accessors[2])[i].begin(), 3, trs.scale.begin());
        copies.push_back(placement_from(trs));
        if (!fits_float(copies.back())) attributes.refuse(fmt::format("copy {} is not finite", i));
    });
    return copies;
}

std::string name_path(const Document& document, const NodeTree& tree, std::size_t node) {
    std::vector<std::string> names;
    for (std::optional<std::size_t> n = node; n && names.size() < 16; n = tree.parent[*n])
        if (std::string name = name_of(document.nodes[*n]); !name.empty()) names.push_back(std::move(name));
    std::reverse(names.begin(), names.end());
    return fmt::format("{}", fmt::join(names, "/"));
}

}  // namespace lobelia::gltf
