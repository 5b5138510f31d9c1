// The surfaces of a world, laid out for shading: one cache line for each triangle, and what its material says there.
#pragma once

#include <span>

#include "scene/world.h"
#include "trace/material.h"
#include "trace/rays.h"
#include "trace/texture.h"

namespace lobelia {

/// What shading needs of a triangle, together.
struct alignas(64) Facet {
    Vec3 corner, edge_u, edge_v;  ///< a point is corner + u * edge_u + v * edge_v
    Vec3 normal;                  ///< unit, of the front
    float lift = 0;               ///< how far to lift a ray's origin off it [m]
    std::uint32_t material = 0;
    std::uint32_t emitter = 0;  ///< number among the emissive triangles, or k_no_emitter
    bool smooth = false;        ///< the vertices' normals differ from `normal`
    bool colored = false;       ///< the vertices have colours
};
inline constexpr std::uint32_t k_no_emitter = 0xffffffff;

/// A point of a surface as a path sees it.
struct SurfacePoint {
    Vec3 origin;  ///< where rays that leave it begin: lifted off the side that is seen
    Vec3 face;    ///< unit normal of the triangle, on the side that is seen
    Vec3 normal;  ///< unit shading normal, on that side, too
    Reflectance reflectance;
};

class Surfaces final : public Transparency {
  public:
    Surfaces(const Scene& scene, const World& world);

    [[nodiscard]] const Facet& facet(std::uint32_t triangle) const { return facets_[triangle]; }
    [[nodiscard]] std::size_t size() const { return facets_.size(); }
    /// The point at (u, v), seen along `direction`.
    [[nodiscard]] SurfacePoint point(std::uint32_t triangle, float u, float v, Vec3 direction) const;
    /// Base colour with texture and the vertices' colours.
    [[nodiscard]] Rgb base_color(std::uint32_t triangle, float u, float v) const;
    /// Radiance from the front, transparency not counted.
    [[nodiscard]] Rgb emission(std::uint32_t triangle, float u, float v) const;
    [[nodiscard]] bool double_sided(std::uint32_t triangle) const {
        return scene_->materials[facets_[triangle].material].double_sided;
    }
    /// Share of light that is stopped: of masks 0 or 1.
    [[nodiscard]] float opacity(std::uint32_t triangle, float u, float v) const;
    [[nodiscard]] bool passes(std::uint32_t triangle, float u, float v, std::uint32_t salt) const override;
    /// Each triangle's kind, as RayScene takes them.
    [[nodiscard]] std::vector<std::uint8_t> kinds() const;
    /// Whether any material has more than a diffuse base.
    [[nodiscard]] bool layered() const { return layered_; }
    /// The triangles that emit, by their number.
    [[nodiscard]] const std::vector<std::uint32_t>& emissive() const { return emissive_; }

  private:
    struct Finish {
        Reflectance reflectance;  ///< where `plain`
        bool plain = false;       ///< no texture: the reflectance is the same everywhere
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

/// How far to lift a ray's origin off a surface whose coordinates are at most `magnitude` [m].
[[nodiscard]] constexpr float lift_of(float magnitude) { return magnitude * 0x1p-20f; }

}  // namespace lobelia
