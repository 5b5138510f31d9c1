// Small scenes made in code, and the statistics that Monte Carlo tests need.
#pragma once

#include <cmath>
#include <map>
#include <utility>

#include "scene/world.h"

namespace lobelia::test {

/// A purely diffuse material, without a specular layer.
inline Material matte(Rgb color, Rgb emission = {}) {
    Material m;
    m.base_color = color;
    m.emission = emission;
    m.specular = 0;
    return m;
}

/// A light of this kind with every field that it may have.
inline PunctualLight some_light(PunctualLight::Kind kind) {
    PunctualLight light;
    light.name = "light";
    light.kind = kind;
    light.intensity = {1, 2, 3};
    light.position = {0.5f, 2, -0.25f};
    light.direction = normalize(Vec3{0.1f, -1, 0.2f});
    light.inner_angle = 0.3f;
    light.outer_angle = 0.8f;
    return light;
}

inline void add_triangle(Mesh& mesh, std::uint32_t material, Vec3 a, Vec3 b, Vec3 c) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : {a, b, c}) mesh.positions.push_back(p);
    mesh.triangles.push_back({n, n + 1, n + 2});
    mesh.materials.push_back(material);
}

/// Corners counter-clockwise from the front; uv (0, 0), (1, 0), (1, 1), (0, 1) in set 0.
inline void add_quad(Mesh& mesh, std::uint32_t material, Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3 p : {a, b, c, d}) mesh.positions.push_back(p);
    for (const Vec2 uv : {Vec2{0, 0}, {1, 0}, {1, 1}, {0, 1}}) mesh.uv[0].push_back(uv);
    for (const auto& triangle : {std::array<std::uint32_t, 3>{n, n + 1, n + 2}, {n, n + 2, n + 3}}) {
        mesh.triangles.push_back(triangle);
        mesh.materials.push_back(material);
    }
}

/// A square of half width `half` about `centre`, in the plane across unit vectors x and y; its front looks along
/// cross(x, y).
inline void add_square(Mesh& mesh, std::uint32_t material, Vec3 centre, Vec3 x, Vec3 y, float half) {
    const Vec3 a = x * half, b = y * half;
    add_quad(mesh, material, centre - a - b, centre + a - b, centre + a + b, centre - a + b);
}

enum class Facing { inwards, outwards };
inline void add_box(Mesh& mesh, std::uint32_t material, Vec3 low, Vec3 high, Facing facing) {
    const auto corner = [&](int i) {
        return Vec3{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z};
    };
    constexpr std::array<std::array<int, 4>, 6> faces{
        {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
    for (const auto& [a, b, c, d] : faces)
        facing == Facing::inwards ? add_quad(mesh, material, corner(a), corner(b), corner(c), corner(d))
                                  : add_quad(mesh, material, corner(d), corner(c), corner(b), corner(a));
}

/// The unit sphere as an octahedron whose faces are divided `levels` times, vertices on the sphere; with normals where
/// they are `smooth`.
enum class Normals { flat, smooth };
inline Mesh make_sphere(std::uint32_t material, int levels, Normals normals) {
    Mesh mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
            if (added) mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const auto& t : {std::array<std::uint32_t, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                finer.push_back(t);
        }
        mesh.triangles = std::move(finer);
    }
    mesh.materials.assign(mesh.triangles.size(), material);
    if (normals == Normals::smooth) mesh.normals = mesh.positions;
    return mesh;
}

inline void add_object(Scene& scene, Mesh mesh, const Transform& world_from_object = {}) {
    scene.objects.push_back({"object", scene.meshes.size(), world_from_object});
    scene.meshes.push_back(std::move(mesh));
}

inline Transform scaled(float scale, Vec3 translation = {}) {
    return {{Vec3{scale, 0, 0}, Vec3{0, scale, 0}, Vec3{0, 0, scale}}, translation};
}

/// An environment of one radiance.
inline Image constant_sky(Rgb radiance) {
    Image image(8, 4);
    std::fill(image.pixels.begin(), image.pixels.end(), radiance);
    return image;
}

/// Mean and standard error of independent numbers.
class Estimate {
  public:
    void add(double v) {
        ++count_;
        const double d = v - mean_;
        mean_ += d / count_;
        squares_ += d * (v - mean_);
    }
    [[nodiscard]] double mean() const { return mean_; }
    [[nodiscard]] double standard_error() const { return std::sqrt(squares_ / (count_ - 1) / count_); }

  private:
    double count_ = 0, mean_ = 0, squares_ = 0;
};

/// Returns the difference of two estimates in standard errors.
inline double deviation(const Estimate& a, const Estimate& b) {
    const double error = std::hypot(a.standard_error(), b.standard_error());
    const double difference = std::abs(a.mean() - b.mean());
    return difference == 0 ? 0 : difference / error;
}

}  // namespace lobelia::test
