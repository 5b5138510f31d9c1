// The sphere as a square: an unfolded octahedron. Praun and Hoppe 2003; Engelhardt and Dachsbacher 2008.
#pragma once

#include <array>
#include <cstddef>

#include "lobelia/math.h"
#include "lobelia/shader_code.h"

namespace lobelia {

/// The octahedron |x| + |y| + |z| = 1, its lower faces folded up and out, as a grid of `resolution`^2 cells in rows; an
/// even resolution, so that no cell lies across an edge other than along its diagonal.
struct OctahedralMap {
    std::size_t resolution = 2;

    [[nodiscard]] std::size_t size() const { return resolution * resolution; }
    /// Direction of the point (u, v) of [-1, 1]^2. The middle is +z, the corners are -z.
    [[nodiscard]] static Vec3 direction(double u, double v);
    /// The place (u, v) of a unit direction, the inverse of direction().
    [[nodiscard]] static std::array<float, 2> place(Vec3 direction);
    /// Returns the index of cell (x, y), x to the right; one step beyond an edge it is where the octahedron goes on.
    [[nodiscard]] std::size_t index_at(int x, int y) const;
    /// Index of the cell that holds a unit direction: v's row, u's column.
    [[nodiscard]] std::size_t index(Vec3 direction) const;
    /// Integrals over a cell [sr]: exact, since it is two spherical triangles, but for the second moment, which is by
    /// quadrature (relative error below 1e-5).
    struct Cell {
        double solid_angle = 0;
        std::array<double, 3> first_moment{};   ///< of w
        std::array<double, 6> second_moment{};  ///< of xx, yy, zz, xy, yz, xz
    };
    [[nodiscard]] Cell cell(std::size_t index) const;
};

/// OctahedralMap::place as shader code: vec2 octahedral_place(vec3 w).
[[nodiscard]] ShaderFunction octahedral_place_code();

}  // namespace lobelia
