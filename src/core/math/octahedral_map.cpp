// The map and exact integrals over its cells.
#include "core/math/octahedral_map.h"

#include <algorithm>
#include <cmath>

#include "core/math/quadrature.h"

namespace lobelia {
namespace {

using Point = std::array<double, 3>;

Point unit(Point p) {
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return {p[0] / length, p[1] / length, p[2] / length};
}
double dot3(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross3(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double sign_of(double x) { return x < 0 ? -1 : 1; }

/// The point of the octahedron that (u, v) stands for.
Point octahedral_point(double u, double v) {
    const double z = 1 - std::abs(u) - std::abs(v);
    if (z >= 0) return {u, v, z};
    return {(1 - std::abs(v)) * sign_of(u), (1 - std::abs(u)) * sign_of(v), z};
}

/// Adds the second moment of the triangle a, b, c seen from the origin: w = p / |p|, dw = |a . (b x c)| s ds dt / |p|^3
/// for p = a + s (b - a) + s t (c - b).
void add_second_moment(OctahedralMap::Cell& cell, const Point& a, const Point& b, const Point& c) {
    static const GaussLegendre rule(4, 0, 1);
    const double volume = std::abs(dot3(a, cross3(b, c)));
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) {
            const double s = rule.nodes[i], t = rule.nodes[j];
            Point p;
            for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + s * (b[k] - a[k]) + s * t * (c[k] - b[k]);
            const double squared = dot3(p, p);
            const double weight =
                rule.weights[i] * rule.weights[j] * s * volume / (squared * squared * std::sqrt(squared));
            for (std::size_t k = 0; k < 6; ++k) cell.second_moment[k] += weight * p[k % 3] * p[k < 3 ? k : (k + 1) % 3];
        }
}

/// Adds a spherical triangle: its solid angle (Van Oosterom and Strackee 1983) and its first moment, half the sum over
/// its edges of their lengths along the normals of their planes (Lambert 1760).
void add_triangle(OctahedralMap::Cell& cell, const Point& a, const Point& b, const Point& c) {
    const double volume = dot3(a, cross3(b, c));
    const double turn = volume < 0 ? -1 : 1;
    cell.solid_angle += 2 * std::atan2(std::abs(volume), 1 + dot3(a, b) + dot3(b, c) + dot3(c, a));
    const std::array edges = {std::array{a, b}, std::array{b, c}, std::array{c, a}};
    for (const auto& [from, to] : edges) {
        const Point normal = cross3(from, to);
        const double sine = std::sqrt(dot3(normal, normal));
        const double length = std::atan2(sine, dot3(from, to));
        for (std::size_t k = 0; k < 3; ++k) cell.first_moment[k] += turn * length / 2 * normal[k] / sine;
    }
}

}  // namespace

Vec3 OctahedralMap::direction(double u, double v) {
    const Point p = unit(octahedral_point(u, v));
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

std::array<float, 2> OctahedralMap::place(Vec3 direction) {
    const float scale = 1 / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    const float u = direction.x * scale, v = direction.y * scale;
    if (direction.z >= 0) return {u, v};
    return {(1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f), (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f)};
}

std::size_t OctahedralMap::index_at(int x, int y) const {
    const auto side = static_cast<int>(resolution);
    if (x < 0 || x >= side) {
        x = std::clamp(x, 0, side - 1);
        y = side - 1 - y;
    }
    if (y < 0 || y >= side) {
        y = std::clamp(y, 0, side - 1);
        x = side - 1 - x;
    }
    return static_cast<std::size_t>(y) * resolution + static_cast<std::size_t>(x);
}

std::size_t OctahedralMap::index(Vec3 direction) const {
    const auto [u, v] = place(direction);
    const auto cell_of = [&](float x) {
        // A NaN becomes 0.
        const float cell = std::max(0.0f, (x + 1) / 2 * static_cast<float>(resolution));
        return static_cast<std::size_t>(std::min(cell, static_cast<float>(resolution - 1)));
    };
    return cell_of(v) * resolution + cell_of(u);
}

OctahedralMap::Cell OctahedralMap::cell(std::size_t index) const {
    const auto edge = [&](std::size_t i) { return 2 * static_cast<double>(i) / static_cast<double>(resolution) - 1; };
    const std::size_t column = index % resolution, row = index / resolution;
    const double u[] = {edge(column), edge(column + 1)}, v[] = {edge(row), edge(row + 1)};
    // Cut it along the diagonal on which |u| + |v| is constant, which may be the octahedron's edge.
    const bool falling = (u[0] + u[1] > 0) == (v[0] + v[1] > 0);
    const Point a = octahedral_point(u[0], falling ? v[1] : v[0]);
    const Point b = octahedral_point(u[1], falling ? v[0] : v[1]);
    Cell result;
    for (const Point& c :
         {octahedral_point(u[0], falling ? v[0] : v[1]), octahedral_point(u[1], falling ? v[1] : v[0])}) {
        add_triangle(result, unit(a), unit(b), unit(c));
        add_second_moment(result, a, b, c);
    }
    return result;
}

ShaderFunction octahedral_place_code() {
    return {
        "octahedral_place",
        "/// Returns the place of a direction on the unfolded octahedron, in [-1, 1]^2 (Praun and Hoppe 2003).\n"
        "vec2 octahedral_place(vec3 w) {\n"
        "    float scale = 1.0 / (abs(w.x) + abs(w.y) + abs(w.z));\n"
        "    float u = w.x * scale;\n"
        "    float v = w.y * scale;\n"
        "    if (w.z >= 0.0) {\n"
        "        return vec2(u, v);\n"
        "    }\n"
        "    return vec2((1.0 - abs(v)) * choose(u < 0.0, -1.0, 1.0), (1.0 - abs(u)) * choose(v < 0.0, -1.0, 1.0));\n"
        "}\n"};
}

}  // namespace lobelia
