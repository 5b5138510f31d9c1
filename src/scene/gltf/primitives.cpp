// The triangles of a glTF primitive, and repair of missing or invalid normals.
#include "scene/gltf/primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobelia::gltf {
namespace {

constexpr std::size_t k_triangles = 4, k_strip = 5, k_fan = 6;  // primitive.mode

std::size_t triangle_count(std::size_t mode, std::size_t indices) {
    if (mode == k_triangles) return indices / 3;
    return indices < 3 ? 0 : indices - 2;
}

/// Positions of triangle t's corners in the index list, as glTF 2.0 (3.7.2.1) orders them.
std::array<std::size_t, 3> corners(std::size_t mode, std::size_t t) {
    if (mode == k_triangles) return {3 * t, 3 * t + 1, 3 * t + 2};
    if (mode == k_strip) return {t, t + 1 + t % 2, t + 2 - t % 2};
    return {t + 1, t + 2, 0};
}

}  // namespace

std::size_t mode_of(const JsonPlace& primitive) {
    const auto found = primitive.find("mode");
    const std::size_t mode = found ? whole(*found) : k_triangles;
    if (mode > k_fan) found->refuse(fmt::format("{}", mode));
    return mode;
}

bool has_triangles(std::size_t mode) { return mode >= k_triangles && mode <= k_fan; }

std::vector<Triangle> read_triangles(Document& document, const JsonPlace& primitive, std::size_t vertices,
                                     std::size_t most) {
    // Open the indices; without any, vertices are used in order.
    std::optional<Accessor> indices;
    const auto at = primitive.find("indices");
    if (at) {
        indices.emplace(document, *at);
        if (!indices->is_unsigned() || indices->components() != 1) at->refuse("not unsigned integers");
    }
    const std::size_t mode = mode_of(primitive);
    const std::size_t count = triangle_count(mode, indices ? indices->count() : vertices);
    if (count > most) primitive.refuse(fmt::format("{} triangles; the limit allows {} more", count, most));
    if (vertices > std::numeric_limits<std::uint32_t>::max()) primitive.refuse(fmt::format("{} vertices", vertices));

    // Read each corner, and check that its vertex exists.
    document.keep(primitive, count, sizeof(Triangle) + sizeof(std::uint32_t));
    std::vector<Triangle> triangles(count);
    document.for_each(primitive, count, [&](std::size_t t) {
        const auto positions = corners(mode, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex =
                indices ? indices->index_at(positions[k]) : static_cast<std::uint32_t>(positions[k]);
            if (vertex >= vertices)
                at->refuse(fmt::format("element {} is vertex {} of {}", positions[k], vertex, vertices));
            triangles[t][k] = vertex;
        }
    });
    return triangles;
}

Vec3 area_vector(const Mesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3 a = mesh.positions[t[0]];
    return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
}

bool opposes_winding(const Mesh& mesh, std::size_t triangle) {
    const Vec3 front = area_vector(mesh, triangle);
    const auto& t = mesh.triangles[triangle];
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return dot(mesh.normals[v], front) < 0; });
}

std::vector<bool> repair_normals(Mesh& mesh) {
    // Find the normals without a direction; scale the others.
    std::vector<bool> bad(mesh.normals.size());
    bool any = false;
    for (std::size_t v = 0; v < bad.size(); ++v) {
        const float l = length(mesh.normals[v]);
        bad[v] = !(l > 1e-12f) || !std::isfinite(l);
        any = any || bad[v];
        // Normals of length 1 stay as they are, to the bit.
        if (bad[v]) {
            mesh.normals[v] = {};
        } else if (std::abs(l - 1) > 1e-6f) {
            mesh.normals[v] = mesh.normals[v] * (1 / l);
        }
    }
    if (!any) return {};

    // Sum the normals of the triangles around them.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t])
            if (bad[v]) mesh.normals[v] = mesh.normals[v] + area_vector(mesh, t);
    for (std::size_t v = 0; v < bad.size(); ++v) {
        if (!bad[v]) continue;
        const float l = length(mesh.normals[v]);
        mesh.normals[v] = l > 0 && std::isfinite(l) ? mesh.normals[v] * (1 / l) : Vec3{0, 0, 1};
    }
    return bad;
}

}  // namespace lobelia::gltf
