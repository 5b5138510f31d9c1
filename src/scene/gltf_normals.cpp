// Normals that a file lacks or spoils.
#include "scene/gltf_normals.h"

#include <cmath>

namespace lobelia::gltf {

Vec3 area_vector(const Mesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3 a = mesh.positions[t[0]];
    return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
}

std::vector<bool> repair_normals(Mesh& mesh) {
    // Tell directions from others.
    std::vector<bool> bad(mesh.normals.size());
    bool any = false;
    for (std::size_t v = 0; v < bad.size(); ++v) {
        const float l = length(mesh.normals[v]);
        bad[v] = !(l > 1e-12f) || !std::isfinite(l);
        any = any || bad[v];
        // Left alone where they are of length 1 already, to the bit.
        if (bad[v]) {
            mesh.normals[v] = {};
        } else if (std::abs(l - 1) > 1e-6f) {
            mesh.normals[v] = mesh.normals[v] * (1 / l);
        }
    }
    if (!any) return {};

    // Gather the triangles around the others.
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
