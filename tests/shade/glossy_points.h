// Points at which tests of shader code evaluate specular reflection.
#pragma once

#include <random>
#include <vector>

#include "lobelia/specular.h"
#include "shader_cases.h"
#include "support.h"

namespace lobelia::test {

/// Points that a viewer sees from above, from below and along the normal, of surfaces from smooth to rough.
struct GlossyPoints {
    Directions normals, views;
    std::vector<float> alphas;
    Rgb f0{0.04f, 0.5f, 1};

    GlossyPoints(Domain domain, std::size_t count)
        : normals(random_directions(domain, count, 9)), views(random_directions(Domain::sphere, count, 10)) {
        std::mt19937 generator(11);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 n = direction_at(normals, i), v = direction_at(views, i);
            // One in eight stays where it is, below the surface or above; one in 64 is along the normal.
            const Vec3 view = i % 64 == 0 ? n : i % 8 == 0 ? v : dot(n, v) < 0 ? v - n * (2 * dot(n, v)) : v;
            set_entry(views, i, normalize(view));
            const float root = uniform(generator);
            alphas.push_back(0.05f + 0.95f * root * root);
        }
    }
    [[nodiscard]] SpecularPoints points() const { return {normals, views, alphas}; }
    /// The floats of the points, and the table.
    [[nodiscard]] std::vector<float> floats() const {
        std::vector<float> all;
        for (std::size_t i = 0; i < alphas.size(); ++i) {
            const Vec3 n = direction_at(normals, i), v = direction_at(views, i);
            all.insert(all.end(), {n.x, n.y, n.z, v.x, v.y, v.z, alphas[i], f0.r, f0.g, f0.b});
        }
        const SpecularTable table = ggx_table();
        all.insert(all.end(), table.texels.begin(), table.texels.end());
        return all;
    }
};

}  // namespace lobelia::test
