// The surfaces of a world, laid out for shading: one cache line per triangle, and material lookups.
#pragma once

#include <span>

#include "scene/world.h"
#include "trace/material.h"
#include "trace/rays.h"
#include "trace/texture.h"

namespace lobelia {

/// Shading data of a triangle.
struct alignas(64) Facet {
    Vec3 corner, edge_u, edge_v;  ///< a point is corner + u * edge_u + v * edge_v
    Vec3 normal;                  ///< unit, on the front
    float lift = 0;               ///< offset of ray origins off the surface [m]
    std::uint32_t material = 0;
    std::uint32_t emitter = 0;  ///< index among the emissive triangles, or k_no_emitter
    bool smooth = false;        ///< the vertices' normals differ from `normal`
    bool colored = false;       ///< the vertices have colours
};
inline constexpr std::uint32_t k_no_emitter = 0xffffffff;

/// A shading point on a surface.
struct SurfacePoint {
    Vec3 origin;  ///< start of rays that leave the surface: offset to the visible side
    Vec3 face;    ///< unit normal of the triangle, on the visible side
    Vec3 normal;  ///< unit shading normal, on the visible side
    Reflectance reflectance;
};

class Surfaces final : public Transparency {
  public:
    Surfaces(const Scene& scene, const World& world);

    [[nodiscard]] const Facet& facet(std::uint32_t triangle) const { return facets_[triangle]; }
    [[nodiscard]] std::size_t size() const { return facets_.size(); }
    /// Returns the shading point at (u, v) for a ray along `direction`.
    [[nodiscard]] SurfacePoint point(std::uint32_t triangle, float u, float v, Vec3 direction) const;
    /// Returns the base colour: factor, texture and vertex colours.
    [[nodiscard]] Rgb base_color(std::uint32_t triangle, float u, float v) const;
    /// Returns the radiance emitted by the front, without transparency.
    [[nodiscard]] Rgb emission(std::uint32_t triangle, float u, float v) const;
    [[nodiscard]] bool double_sided(std::uint32_t triangle) const {
        return scene_->materials[facets_[triangle].material].double_sided;
    }
    /// Returns the fraction of light that is blocked; 0 or 1 for alpha masks.
    [[nodiscard]] float opacity(std::uint32_t triangle, float u, float v) const;
    [[nodiscard]] bool passes(std::uint32_t triangle, float u, float v, std::uint32_t salt) const override;
    /// Returns each triangle's kind, for RayScene.
    [[nodiscard]] std::vector<std::uint8_t> kinds() const;
    /// Returns whether any material has more than a diffuse base.
    [[nodiscard]] bool layered() const { return layered_; }
    /// Returns the emissive triangles, ordered by emitter index.
    [[nodiscard]] const std::vector<std::uint32_t>& emissive() const { return emissive_; }

  private:
    struct Finish {
        Reflectance reflectance;  ///< valid if `plain`
        bool plain = false;       ///< no texture: the same reflectance everywhere
    };
    [[nodiscard]] Vec2 uv(std::uint32_t triangle, float u, float v, std::size_t set) const;
    [[nodiscard]] std::array<float, 4> read(const TextureUse& use, Curve curve, std::uint32_t triangle, float u,
                                            float v) const;
    [[nodiscard]] std::array<float, 4> vertex_color(std::uint32_t triangle, float u, float v) const;
    [[nodiscard]] Reflectance reflectance(std::uint32_t triangle, float u, float v) const;

    const Scene* scene_;
    const World* world_;
    std::vector<Facet> facets_;
    std::vector<Finish> finishes_;
    std::vector<std::uint32_t> emissive_;
    bool layered_ = false;
};

/// Returns the offset [m] of ray origins off a surface whose coordinates are at most `magnitude`.
[[nodiscard]] constexpr float lift_of(float magnitude) { return magnitude * 0x1p-20f; }

}  // namespace lobelia
