// Shading points from triangles and materials.
#include "trace/surface.h"

namespace lobelia {
namespace {

float magnitude(Vec3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

template <class T>
T blend(const T& a, const T& b, const T& c, float u, float v) {
    return a * (1 - u - v) + b * u + c * v;
}

/// Vertex normals within this cosine of the triangle's normal count as equal to it.
constexpr float k_flat_cosine = 1 - 1e-6f;

}  // namespace

Surfaces::Surfaces(const Scene& scene, const World& world) : scene_(&scene), world_(&world) {
    for (const Material& m : scene.materials) {
        const bool plain = m.unlit || (!m.base_color_texture && !m.metallic_roughness_texture);
        layered_ |= m.metallic > 0 || m.specular > 0;
        finishes_.push_back({make_reflectance(m, m.base_color, m.metallic, m.roughness), plain});
    }
    facets_.resize(world.triangles.size());
    for (std::uint32_t t = 0; t < facets_.size(); ++t) {
        const auto& corners = world.triangles[t];
        const Vec3 a = world.positions[corners[0]], b = world.positions[corners[1]], c = world.positions[corners[2]];
        Facet& f = facets_[t];
        f.corner = a, f.edge_u = b - a, f.edge_v = c - a;
        f.normal = world.face_normal(t);
        f.lift = lift_of(std::max({magnitude(a), magnitude(b), magnitude(c)}));
        f.material = world.material[t];
        f.emitter = k_no_emitter;
        for (std::uint32_t v : corners) {
            f.smooth |= dot(world.normals[v], f.normal) < k_flat_cosine;
            f.colored |= !world.colors.empty() && world.colors[v] != std::array<float, 4>{1, 1, 1, 1};
        }
        const Material& m = scene.materials[f.material];
        const bool has_area = f.normal != Vec3{};
        if (has_area && !m.unlit && !is_black(m.emission)) {
            f.emitter = static_cast<std::uint32_t>(emissive_.size());
            emissive_.push_back(t);
        }
    }
}

std::vector<std::uint8_t> Surfaces::kinds() const {
    std::vector<std::uint8_t> kinds(facets_.size());
    for (std::size_t t = 0; t < kinds.size(); ++t) {
        const Material& m = scene_->materials[facets_[t].material];
        if (!m.double_sided) kinds[t] |= k_one_sided;
        const bool may_be_clear = m.alpha < 1 || m.base_color_texture || facets_[t].colored;
        if (m.alpha_mode != Material::Alpha::opaque && may_be_clear) kinds[t] |= k_transparent;
    }
    return kinds;
}

Vec2 Surfaces::uv(std::uint32_t triangle, float u, float v, std::size_t set) const {
    const auto& corners = world_->triangles[triangle];
    const auto& uvs = world_->uv[set];
    const Vec2 a = uvs[corners[0]], b = uvs[corners[1]], c = uvs[corners[2]];
    return a * (1 - u - v) + b * u + c * v;
}

std::array<float, 4> Surfaces::read(const TextureUse& use, Curve curve, std::uint32_t triangle, float u,
                                    float v) const {
    return texture_value(scene_->textures[use.texture], texture_uv(use, uv(triangle, u, v, use.uv_set)), curve);
}

std::array<float, 4> Surfaces::vertex_color(std::uint32_t triangle, float u, float v) const {
    const auto& [i, j, k] = world_->triangles[triangle];
    std::array<float, 4> sum{};
    for (std::size_t c = 0; c < 4; ++c)
        sum[c] = world_->colors[i][c] * (1 - u - v) + world_->colors[j][c] * u + world_->colors[k][c] * v;
    return sum;
}

Rgb Surfaces::base_color(std::uint32_t triangle, float u, float v) const {
    const Material& m = scene_->materials[facets_[triangle].material];
    Rgb base = m.base_color;
    if (facets_[triangle].colored) {
        const auto c = vertex_color(triangle, u, v);
        base = product(base, {c[0], c[1], c[2]});
    }
    if (m.base_color_texture) {
        const auto c = read(*m.base_color_texture, Curve::srgb, triangle, u, v);
        base = product(base, {c[0], c[1], c[2]});
    }
    return base;
}

Reflectance Surfaces::reflectance(std::uint32_t triangle, float u, float v) const {
    const Material& m = scene_->materials[facets_[triangle].material];
    const Rgb base = base_color(triangle, u, v);
    float metallic = m.metallic, roughness = m.roughness;
    if (m.metallic_roughness_texture) {
        const auto c = read(*m.metallic_roughness_texture, Curve::linear, triangle, u, v);
        roughness *= c[1];
        metallic *= c[2];
    }
    return make_reflectance(m, base, metallic, roughness);
}

SurfacePoint Surfaces::point(std::uint32_t triangle, float u, float v, Vec3 direction) const {
    const Facet& f = facets_[triangle];
    const float side = dot(f.normal, direction) > 0 ? -1.0f : 1.0f;
    SurfacePoint p;
    p.face = p.normal = f.normal * side;
    p.origin = f.corner + f.edge_u * u + f.edge_v * v + p.face * f.lift;
    if (f.smooth) {
        const auto& corners = world_->triangles[triangle];
        const Vec3 n =
            blend(world_->normals[corners[0]], world_->normals[corners[1]], world_->normals[corners[2]], u, v) * side;
        // Fall back to the triangle's normal where the smooth one is degenerate or faces away.
        const float size = length(n);
        if (size > 0 && dot(n, direction) < 0 && dot(n, p.face) > 0) p.normal = n * (1 / size);
    }
    const Finish& finish = finishes_[f.material];
    p.reflectance = finish.plain && !f.colored ? finish.reflectance : reflectance(triangle, u, v);
    return p;
}

Rgb Surfaces::emission(std::uint32_t triangle, float u, float v) const {
    const Material& m = scene_->materials[facets_[triangle].material];
    if (!m.emissive_texture) return m.emission;
    const auto c = read(*m.emissive_texture, Curve::srgb, triangle, u, v);
    return product(m.emission, {c[0], c[1], c[2]});
}

float Surfaces::opacity(std::uint32_t triangle, float u, float v) const {
    const Material& m = scene_->materials[facets_[triangle].material];
    if (m.alpha_mode == Material::Alpha::opaque) return 1;
    float alpha = m.alpha;
    if (facets_[triangle].colored) alpha *= vertex_color(triangle, u, v)[3];
    if (m.base_color_texture) alpha *= read(*m.base_color_texture, Curve::srgb, triangle, u, v)[3];
    if (m.alpha_mode == Material::Alpha::mask) return alpha >= m.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha, 0.0f, 1.0f);
}

bool Surfaces::passes(std::uint32_t triangle, float u, float v, std::uint32_t salt) const {
    return unit_float(mix(salt, triangle)) >= opacity(triangle, u, v);
}

}  // namespace lobelia
