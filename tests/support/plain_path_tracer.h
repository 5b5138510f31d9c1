// The path tracer's oracle: slow, plain, in double precision. It tests every triangle, sends no shadow rays to sources
// that can be hit by chance, draws from std::mt19937, and samples every reflection by the cosine.
#pragma once

#include <random>

#include "scene/world.h"

namespace lobelia::test {

struct Vec3d {
    double x = 0, y = 0, z = 0;
    Vec3d() = default;
    Vec3d(double a, double b, double c) : x(a), y(b), z(c) {}
    Vec3d(Vec3 v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT(google-explicit-constructor): only more digits
    Vec3d(Rgb v) : x(v.r), y(v.g), z(v.b) {}   // NOLINT(google-explicit-constructor)
    friend Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
    friend Vec3d operator*(Vec3d a, Vec3d b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
};
inline double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(Vec3d a, Vec3d b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }
inline Vec3d normalize(Vec3d a) { return a * (1 / length(a)); }

class PlainPathTracer {
  public:
    PlainPathTracer(const Scene& scene, int bounces, std::uint32_t seed)
        : scene_(scene), world_(make_world(scene)), bounces_(bounces), generator_(seed) {}

    /// Returns one estimate of the irradiance at a point off all surfaces, from the hemisphere about `normal`.
    Vec3d irradiance(Vec3d position, Vec3d normal) {
        // A uniform direction of the hemisphere, density 1 / (2 pi).
        Vec3d direction = uniform_direction();
        if (dot(direction, normal) < 0) direction = direction * -1;
        // Receivers see no light past the backs of one-sided surfaces.
        backs_stop_ = true;
        Vec3d sum;
        for (const PunctualLight& light : scene_.lights) sum = sum + punctual(light, position, normal);
        const Hit first = first_stop(position, direction, INFINITY);
        backs_stop_ = false;
        const bool back =
            first.distance < INFINITY && !material(first).double_sided && dot(face(first.triangle), direction) > 0;
        return back ? sum : sum + radiance(position, direction, first) * (dot(direction, normal) * 2 * k_pi);
    }

  private:
    struct Hit {
        double distance = INFINITY, u = 0, v = 0;
        std::size_t triangle = 0;
    };

    double random() { return static_cast<double>(generator_()) * 0x1p-32; }
    Vec3d uniform_direction() {
        const double z = 1 - 2 * random(), phi = 2 * k_pi * random(), r = std::sqrt(1 - z * z);
        return {r * std::cos(phi), r * std::sin(phi), z};
    }

    Vec3d face(std::size_t t) const {
        const auto& [a, b, c] = world_.triangles[t];
        const Vec3d p = world_.positions[a];
        return normalize(cross(Vec3d(world_.positions[b]) - p, Vec3d(world_.positions[c]) - p));
    }
    const Material& material(const Hit& hit) const { return scene_.materials[world_.material[hit.triangle]]; }

    /// The first surface that stops light, by Cramer's rule for each triangle; chance decides at transparent ones.
    Hit first_stop(Vec3d origin, Vec3d direction, double farthest) {
        Hit best;
        best.distance = farthest;
        for (std::size_t t = 0; t < world_.triangles.size(); ++t) {
            const auto& [i, j, k] = world_.triangles[t];
            const Vec3d a = world_.positions[i], e = Vec3d(world_.positions[j]) - a, f = Vec3d(world_.positions[k]) - a;
            const Vec3d q = cross(direction, f), s = origin - a;
            const double determinant = dot(e, q);
            if (determinant == 0) continue;
            const double u = dot(s, q) / determinant;
            const Vec3d r = cross(s, e);
            const double v = dot(direction, r) / determinant, distance = dot(f, r) / determinant;
            if (u < 0 || v < 0 || u + v > 1 || distance < 1e-9 || distance >= best.distance) continue;
            Hit hit;
            hit.distance = distance, hit.u = u, hit.v = v, hit.triangle = t;
            if (stops(hit, direction)) best = hit;
        }
        return best;
    }
    bool stops(const Hit& hit, Vec3d direction) {
        const Material& m = material(hit);
        if (!backs_stop_ && !m.double_sided && dot(face(hit.triangle), direction) > 0) return false;
        if (m.alpha_mode == Material::Alpha::opaque) return true;
        double alpha = m.alpha * color(hit, 3);
        if (m.base_color_texture) alpha *= texture(*m.base_color_texture, hit, 3, false);
        return m.alpha_mode == Material::Alpha::mask ? alpha >= m.alpha_cutoff : random() < alpha;
    }

    double color(const Hit& hit, std::size_t channel) const {
        if (world_.colors.empty()) return 1;
        const auto& [i, j, k] = world_.triangles[hit.triangle];
        return world_.colors[i][channel] * (1 - hit.u - hit.v) + world_.colors[j][channel] * hit.u +
               world_.colors[k][channel] * hit.v;
    }
    /// One channel of a repeated texture, filtered bilinearly.
    double texture(const TextureUse& use, const Hit& hit, std::size_t channel, bool srgb) const {
        const auto& [i, j, k] = world_.triangles[hit.triangle];
        const auto& uv = world_.uv[use.uv_set];
        const double w = 1 - hit.u - hit.v, x = uv[i].x * w + uv[j].x * hit.u + uv[k].x * hit.v,
                     y = uv[i].y * w + uv[j].y * hit.u + uv[k].y * hit.v;
        const Texture& t = scene_.textures[use.texture];
        const auto& m = use.uv_from_mesh;
        const double s = (m[0][0] * x + m[0][1] * y + m[0][2]) * static_cast<double>(t.width) - 0.5,
                     r = (m[1][0] * x + m[1][1] * y + m[1][2]) * static_cast<double>(t.height) - 0.5;
        double sum = 0;
        for (int dy = 0; dy < 2; ++dy)
            for (int dx = 0; dx < 2; ++dx) {
                const auto wrap = [](double v, std::size_t n) {
                    const double size = static_cast<double>(n);
                    return static_cast<std::size_t>(v - std::floor(v / size) * size);
                };
                const double value = t.texels[wrap(std::floor(r) + dy, t.height) * t.width +
                                              wrap(std::floor(s) + dx, t.width)][channel] /
                                     255.0;
                const double linear = !srgb              ? value
                                      : value <= 0.04045 ? value / 12.92
                                                         : std::pow((value + 0.055) / 1.055, 2.4);
                const double fx = s - std::floor(s), fy = r - std::floor(r);
                sum += (dx == 1 ? fx : 1 - fx) * (dy == 1 ? fy : 1 - fy) * linear;
            }
        return sum;
    }
    Vec3d texture_color(const TextureUse& use, const Hit& hit) const {
        return {texture(use, hit, 0, true), texture(use, hit, 1, true), texture(use, hit, 2, true)};
    }

    Vec3d emission(const Hit& hit) const {
        const Material& m = material(hit);
        if (m.unlit) return {};
        return m.emissive_texture ? Vec3d(m.emission) * texture_color(*m.emissive_texture, hit) : Vec3d(m.emission);
    }
    Vec3d sky(Vec3d direction) const {
        Vec3d sum;
        if (scene_.environment) {
            const Image& image = *scene_.environment;
            const double u = (1 + std::atan2(direction.x, -direction.z) / k_pi) / 2, v = std::acos(direction.y) / k_pi;
            const auto cell = [](double at, std::size_t n) {
                return std::min(static_cast<std::size_t>(at * static_cast<double>(n)), n - 1);
            };
            sum = Vec3d(image.at(cell(u, image.width), cell(v, image.height)));
        }
        for (const PunctualLight& light : scene_.lights)
            if (light.kind == PunctualLight::Kind::directional && light.angular_radius > 0 &&
                -dot(direction, light.direction) > std::cos(light.angular_radius))
                sum = sum + Vec3d(light.intensity) * (1 / (k_pi * std::pow(std::sin(light.angular_radius), 2)));
        return sum;
    }

    /// Irradiance from a source without size, which no path hits by chance.
    Vec3d punctual(const PunctualLight& light, Vec3d position, Vec3d normal) {
        Vec3d towards = Vec3d(light.direction) * -1;
        double distance = INFINITY, factor = 1;
        if (light.kind == PunctualLight::Kind::directional) {
            if (light.angular_radius > 0) return {};
        } else {
            towards = Vec3d(light.position) - position;
            distance = length(towards);
            towards = towards * (1 / distance);
            factor = 1 / (distance * distance);
            if (light.range > 0) factor *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
            if (light.kind == PunctualLight::Kind::spot) {
                const double inner = std::cos(light.inner_angle), outer = std::cos(light.outer_angle);
                const double t = (-dot(towards, light.direction) - outer) / std::max(0.001, inner - outer);
                factor *= std::pow(std::clamp(t, 0.0, 1.0), 2);
            }
        }
        const double cosine = dot(towards, normal);
        if (cosine <= 0 || first_stop(position, towards, distance).distance < distance) return {};
        last_direction_ = towards;
        return Vec3d(light.intensity) * (factor * cosine);
    }

    /// glTF's reflectance distribution, written out as in its Appendix B.
    Vec3d reflectance(const Hit& hit, Vec3d n, Vec3d wo, Vec3d wi) const {
        const Material& m = material(hit);
        if (m.unlit) return {};
        Vec3d base = Vec3d(m.base_color) * Vec3d(color(hit, 0), color(hit, 1), color(hit, 2));
        double metallic = m.metallic, roughness = m.roughness;
        if (m.base_color_texture) base = base * texture_color(*m.base_color_texture, hit);
        if (m.metallic_roughness_texture) {
            roughness *= texture(*m.metallic_roughness_texture, hit, 1, false);
            metallic *= texture(*m.metallic_roughness_texture, hit, 2, false);
        }
        const Vec3d h = normalize(wo + wi);
        const double a2 = std::pow(std::max(roughness * roughness, 1e-3), 2), nh = dot(n, h), no = dot(n, wo),
                     ni = dot(n, wi), power = std::pow(1 - std::abs(dot(wo, h)), 5);
        const double d = a2 / (k_pi * std::pow(nh * nh * (a2 - 1) + 1, 2));
        // Height-correlated Smith.
        const double visibility =
            0.5 / (ni * std::sqrt(no * no * (1 - a2) + a2) + no * std::sqrt(ni * ni * (1 - a2) + a2));
        const double f0 = std::pow((m.ior - 1) / (m.ior + 1), 2);
        const auto coat_0 = [&](double tint) { return std::min(f0 * tint, 1.0) * m.specular; };
        const Vec3d zero{coat_0(m.specular_color.r), coat_0(m.specular_color.g), coat_0(m.specular_color.b)};
        const Vec3d one{1, 1, 1};
        const Vec3d coat = zero + (one * m.specular - zero) * power;
        const double taken = std::max({coat.x, coat.y, coat.z});
        const Vec3d dielectric = base * ((1 - taken) / k_pi) + coat * (d * visibility);
        const Vec3d metal = (base + (one - base) * power) * (d * visibility);
        return metal * metallic + dielectric * (1 - metallic);
    }

    /// Radiance from `direction`, where the path first hits `hit`.
    Vec3d radiance(Vec3d origin, Vec3d direction, Hit hit) {
        Vec3d sum, throughput{1, 1, 1};
        for (int depth = 0;; ++depth) {
            if (depth > 0) hit = first_stop(origin, direction, INFINITY);
            if (hit.distance == INFINITY) return sum + throughput * sky(direction);
            sum = sum + throughput * emission(hit);
            if (depth == bounces_) return sum;

            // Normals on the visible side; the smooth one unless it faces away.
            const double side = dot(face(hit.triangle), direction) > 0 ? -1 : 1;
            const Vec3d flat = face(hit.triangle) * side, wo = direction * -1;
            const auto& [i, j, k] = world_.triangles[hit.triangle];
            Vec3d n = normalize(Vec3d(world_.normals[i]) * (1 - hit.u - hit.v) + Vec3d(world_.normals[j]) * hit.u +
                                Vec3d(world_.normals[k]) * hit.v) *
                      side;
            if (dot(n, wo) <= 0 || dot(n, flat) <= 0) n = flat;
            origin = origin + direction * hit.distance + flat * 1e-7;

            for (const PunctualLight& light : scene_.lights) {
                const Vec3d e = punctual(light, origin, n);
                if (dot(e, e) > 0 && dot(last_direction_, flat) > 0)
                    sum = sum + throughput * reflectance(hit, n, wo, last_direction_) * e;
            }

            // A cosine-weighted direction: uniform on the sphere about the normal's tip. Density cosine / pi.
            direction = normalize(n + uniform_direction());
            if (dot(direction, flat) <= 0) return sum;
            throughput = throughput * reflectance(hit, n, wo, direction) * k_pi;
        }
    }

    const Scene& scene_;
    World world_;
    int bounces_;
    std::mt19937 generator_;
    Vec3d last_direction_;
    bool backs_stop_ = false;
};

}  // namespace lobelia::test
