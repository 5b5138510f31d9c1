// Ray-triangle intersection: Embree 3 or 4 behind one interface. Only rays.* depend on the version.
// Wald et al. 2014 (Embree); Woop et al. 2013 (no gaps between triangles).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "scene/world.h"

namespace lobelia {

inline constexpr float k_infinite = std::numeric_limits<float>::infinity();

/// The first triangle hit.
struct RayHit {
    float distance = 0;  ///< infinite: none
    std::uint32_t triangle = 0;
    float u = 0, v = 0;  ///< barycentric weights of the triangle's vertices 1 and 2
};

/// Flags: how a triangle treats light that crosses it.
inline constexpr std::uint8_t k_one_sided = 1;    ///< light from behind passes
inline constexpr std::uint8_t k_transparent = 2;  ///< Transparency::passes decides

/// Decides which light passes through a transparent triangle's front. The result must depend on the arguments alone:
/// the same point may be queried more than once.
class Transparency {
  public:
    virtual ~Transparency() = default;
    [[nodiscard]] virtual bool passes(std::uint32_t triangle, float u, float v, std::uint32_t salt) const = 0;
};

/// Behaviour of light that hits the back of a one-sided triangle.
enum class Backs { pass, stop };

/// The triangles of a world. Immutable; safe for concurrent queries.
class RayScene {
  public:
    /// One entry of `kinds` for each triangle; `transparency` must outlive this. Throws Stopped.
    RayScene(const World& world, std::vector<std::uint8_t> kinds, const Transparency& transparency, StopFlag stop = {});
    ~RayScene();
    RayScene(const RayScene&) = delete;
    RayScene& operator=(const RayScene&) = delete;

    /// Returns the first surface of any kind between 0 and `farthest`.
    [[nodiscard]] RayHit closest(Vec3 origin, Vec3 direction, float farthest) const;
    /// Returns the first surface that blocks light; `salt` is the ray's random number for blended transparency.
    [[nodiscard]] RayHit closest_stop(Vec3 origin, Vec3 direction, std::uint32_t salt, Backs backs) const;
    /// Returns whether a surface blocks light within `distance`.
    [[nodiscard]] bool stopped(Vec3 origin, Vec3 direction, float distance, std::uint32_t salt, Backs backs) const;

    [[nodiscard]] std::uint8_t kind(std::uint32_t triangle) const { return kinds_[triangle]; }

  private:
    struct Handles;
    void release();

    std::vector<std::uint8_t> kinds_;
    const Transparency* transparency_;
    Handles* handles_;
    std::uint8_t all_kinds_;  ///< union of all triangles' kinds
};

}  // namespace lobelia
