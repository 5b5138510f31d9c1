// The rest pose of a mesh: morph targets at their default weights, then the skin.
#include "scene/gltf/pose.h"

#include <algorithm>
#include <cmath>

#include "scene/world.h"

namespace lobelia::gltf {
namespace {

constexpr std::size_t k_most_targets = 4096, k_most_joints = 65536;

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Accessor open_attribute(Document& document, const JsonPlace& index, std::size_t components, std::size_t count) {
    Accessor accessor(document, index);
    if (accessor.components() != components) index.refuse(fmt::format("{} components", accessor.components()));
    if (accessor.count() < count) index.refuse(fmt::format("{} elements for {} vertices", accessor.count(), count));
    return accessor;
}

/// Adds a target's displacements of one attribute.
void add_target(Document& document, const JsonPlace& target, const char* name, double weight,
                const PosedVertices& vertices, std::vector<Vec3>& values) {
    const auto index = target.find(name);
    if (!index || values.empty()) return;
    const Accessor accessor = open_attribute(document, *index, 3, vertices.count);
    document.for_each(*index, vertices.used.size(), [&](std::size_t i) {
        const auto d = accessor[vertices.used[i]];
        Vec3& value = values[vertices.first + i];
        value = value + Vec3{d[0], d[1], d[2]} * static_cast<float>(weight);
        if (!is_finite(value)) index->refuse(fmt::format("element {} is not finite", vertices.used[i]));
    });
}

/// The joints of each vertex, four per set, and their weights.
struct Influences {
    Accessor joints, weights;
};

std::vector<Influences> open_influences(Document& document, const JsonPlace& primitive, std::size_t count) {
    const JsonPlace attributes = primitive.at("attributes");
    std::vector<Influences> sets;
    for (std::size_t set = 0;; ++set) {
        const auto joints = attributes.find(fmt::format("JOINTS_{}", set).c_str());
        const auto weights = attributes.find(fmt::format("WEIGHTS_{}", set).c_str());
        if (!joints || !weights) break;
        sets.push_back({open_attribute(document, *joints, 4, count), open_attribute(document, *weights, 4, count)});
        if (!sets.back().joints.is_unsigned()) joints->refuse("not unsigned integers");
    }
    if (sets.empty()) attributes.refuse("no JOINTS_0 and WEIGHTS_0, though its node has a skin");
    return sets;
}

/// Returns the sum of the joints' matrices weighted by a vertex's weights, which are scaled to a sum of 1; the first
/// joint's matrix if they are all 0.
Placement blend(const Pose& pose, const std::vector<Influences>& sets, std::uint32_t vertex,
                const JsonPlace& primitive) {
    Placement sum{.rows = {}};
    double total = 0;
    const auto add = [&](const Placement& joint, double weight) {
        total += weight;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 4; ++c) sum.rows[r][c] += weight * joint.rows[r][c];
    };
    for (const Influences& set : sets) {
        const auto weights = set.weights[vertex];
        for (std::size_t k = 0; k < 4; ++k) {
            if (weights[k] == 0) continue;
            const std::uint32_t joint = set.joints.index_at(vertex, k);
            if (!(weights[k] > 0) || !std::isfinite(weights[k]) || joint >= pose.joints.size())
                primitive.refuse(fmt::format("vertex {} has weight {} of joint {} of {}", vertex, weights[k], joint,
                                             pose.joints.size()));
            add(pose.joints[joint], static_cast<double>(weights[k]));
        }
    }
    if (total == 0) return pose.joints.front();
    for (auto& row : sum.rows)
        for (double& x : row) x /= total;
    return sum;
}

}  // namespace

std::vector<double> morph_weights(const JsonPlace& node, const JsonPlace& mesh) {
    auto list = node.find("weights");
    if (!list) list = mesh.find("weights");
    std::vector<double> weights;
    if (list)
        for (const JsonPlace& weight : list->list(k_most_targets)) weights.push_back(weight.number());
    const bool moves = std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0; });
    return moves ? weights : std::vector<double>();
}

std::vector<Placement> joint_matrices(Document& document, const NodeTree& tree, std::size_t skin,
                                      const std::array<double, 3>& origin) {
    const JsonPlace& source = document.skins[skin];
    std::optional<Accessor> inverse_bind;
    const auto joints = source.at("joints").list(k_most_joints);
    if (joints.empty()) source.refuse("no joints");
    document.work(source, joints.size());
    if (const auto index = source.find("inverseBindMatrices")) {
        inverse_bind.emplace(document, *index, 16);
        if (inverse_bind->components() != 16 || inverse_bind->count() < joints.size())
            index->refuse(fmt::format("not a MAT4 for each of {} joints", joints.size()));
    }
    std::vector<Placement> matrices;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        Placement world = tree.world_from_node[index_below(joints[j], document.nodes.size())];
        for (std::size_t i = 0; i < 3; ++i) world.rows[i][3] -= origin[i];
        if (inverse_bind) {
            // Column by column.
            std::array<float, 16> m{};
            inverse_bind->get(j, m);
            Placement bind;
            for (std::size_t row = 0; row < 3; ++row)
                for (std::size_t column = 0; column < 4; ++column)
                    bind.rows[row][column] = static_cast<double>(m[4 * column + row]);
            world = product(world, bind);
        }
        for (const auto& row : world.rows)
            for (const double x : row)
                if (!(std::abs(x) < 1e30)) source.refuse(fmt::format("the matrix of joint {} is not finite", j));
        matrices.push_back(world);
    }
    return matrices;
}

std::vector<bool> apply_pose(Document& document, const Pose& pose, const JsonPlace& primitive,
                             const PosedVertices& vertices, Mesh& mesh) {
    if (const auto targets = primitive.find("targets"); targets && !pose.weights.empty()) {
        const auto list = targets->list(k_most_targets);
        for (std::size_t t = 0; t < std::min(list.size(), pose.weights.size()); ++t) {
            if (pose.weights[t] == 0) continue;
            add_target(document, list[t], "POSITION", pose.weights[t], vertices, mesh.positions);
            add_target(document, list[t], "NORMAL", pose.weights[t], vertices, mesh.normals);
        }
    }
    if (pose.joints.empty()) return {};

    const auto sets = open_influences(document, primitive, vertices.count);
    std::vector<bool> mirrored(vertices.used.size());
    document.for_each(primitive, vertices.used.size(), [&](std::size_t i) {
        document.work(primitive, sets.size());
        const Transform t = relative_to({}, blend(pose, sets, vertices.used[i], primitive));
        Vec3& position = mesh.positions[vertices.first + i];
        position = transform_point(t, position);
        if (!is_finite(position)) primitive.refuse(fmt::format("vertex {} is moved too far", vertices.used[i]));
        mirrored[i] = determinant(t) < 0;
        if (!mesh.normals.empty()) {
            Vec3& normal = mesh.normals[vertices.first + i];
            normal = transform_normal(t, normal);
        }
    });
    return mirrored;
}

}  // namespace lobelia::gltf
