// The twelve vertices and twenty faces of the regular icosahedron, which ambient dice stand on.
#pragma once

#include <array>

#include "lobelia/math.h"

namespace lobelia::icosahedron {

/// Unit vertices: the cyclic permutations of (+-1, +-1 / golden ratio, 0), opposite ones side by side.
[[nodiscard]] inline const std::array<Vec3, 12>& vertices() {
    static const std::array<Vec3, 12> list = [] {
        const double t = (std::sqrt(5.0) - 1) / 2, scale = 1 / std::sqrt(1 + t * t);
        const auto a = static_cast<float>(scale), b = static_cast<float>(scale * t);
        std::array<Vec3, 12> result;
        std::size_t i = 0;
        for (const float sign : {1.0f, -1.0f}) {
            for (const Vec3 v : {Vec3{a, sign * b, 0}, {0, a, sign * b}, {sign * b, 0, a}}) {
                result[i++] = v;
                result[i++] = v * -1.0f;
            }
        }
        return result;
    }();
    return list;
}

/// Each face as three vertices, counterclockwise seen from outside.
[[nodiscard]] inline const std::array<std::array<std::size_t, 3>, 20>& faces() {
    static const std::array<std::array<std::size_t, 3>, 20> list = [] {
        // Neighbours have the cosine 1 / sqrt 5, other vertices -1 / sqrt 5 or -1.
        const auto& v = vertices();
        const auto near = [&](std::size_t i, std::size_t j) { return dot(v[i], v[j]) > 0.3f && i != j; };
        std::array<std::array<std::size_t, 3>, 20> result{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 12; ++i)
            for (std::size_t j = i + 1; j < 12; ++j)
                for (std::size_t k = j + 1; k < 12; ++k) {
                    if (!near(i, j) || !near(j, k) || !near(i, k)) continue;
                    const bool outside = dot(cross(v[i], v[j]), v[k]) > 0;
                    result[count++] = outside ? std::array{i, j, k} : std::array{i, k, j};
                }
        return result;
    }();
    return list;
}

}  // namespace lobelia::icosahedron
