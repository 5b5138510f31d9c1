// Light transport: radiance that arrives along a ray, and direct light that arrives at a point.
// Kajiya 1986 (the equation); Veach 1997 (multiple importance sampling); Walter et al. 2007, Heitz 2018 (GGX).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "lobelia/render.h"
#include "scene/world.h"

namespace lobelia {

/// The start of a path: `key` identifies the receiver (texel, probe or pixel), `sample` the point of its Owen-scrambled
/// Sobol sequences (Burley 2020). The same key, sample and seed give the same path.
struct PathStart {
    Vec3 origin;
    Vec3 direction;  ///< unit, from the receiver outwards
    std::uint32_t key = 0;
    std::uint32_t sample = 0;
};

/// Light that arrives along a ray.
struct Incident {
    Rgb scattered;         ///< radiance reflected by at least one surface [W/(m^2 sr)]
    Rgb emitted;           ///< radiance emitted by the first source on the ray, environment included
    float source_pdf = 0;  ///< density [1/sr] with which `direct` samples this direction; 0: never
    float distance = 0;  ///< distance to the first surface that blocks light, or to that back face [m]; infinite: none
    bool back_face = false;  ///< the first surface shows the back of a one-sided material: a leak
};

/// One sampled light source: a direction, and irradiance across it.
struct DirectLight {
    Vec3 direction;  ///< towards the source, unit
    Rgb irradiance;  ///< L / pdf, or of a light without size; on a surface facing it [W/m^2]; 0: occluded or none
    float pdf = 0;   ///< density of the direction [1/sr]; 0 if only `direct` can sample this light (it has no size)
};

/// Immutable; shared between threads, each with its own scratch.
class PathTracer {
  public:
    class Scratch;
    /// Builds the acceleration structure and the tables of light sources. Throws Stopped.
    PathTracer(const Scene& scene, const World& world, const PathOptions& options = {}, StopFlag stop = {});
    ~PathTracer();
    PathTracer(const PathTracer&) = delete;
    PathTracer& operator=(const PathTracer&) = delete;

    [[nodiscard]] std::unique_ptr<Scratch, void (*)(Scratch*)> make_scratch() const;

    /// Traces each path into the entry of `out` with the same index. Any number of starts; a few hundred or more use
    /// the machine fully. `normals` (one each, or none) are those passed to `direct` for the same starts: `source_pdf`
    /// depends on them.
    void trace(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<Incident> out,
               Scratch& scratch) const;
    void trace(std::span<const PathStart> starts, std::span<Incident> out, Scratch& scratch) const {
        trace(starts, {}, out, scratch);
    }

    /// Samples one light source for each start (ignoring its direction), in proportion to power and, roughly, distance;
    /// with normals (one each, or none), lights below the plane through the origin are not sampled. Returns black if
    /// next_event is off. The backs of one-sided surfaces block the light, because receivers may not see them.
    void direct(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<DirectLight> out,
                Scratch& scratch) const;

    /// Closest hits without shading, for geometric queries. All surfaces count, whatever their material.
    struct Hit {
        float distance = 0;  ///< infinite: none
        std::uint32_t triangle = 0;
        float u = 0, v = 0;      ///< barycentric weights of the triangle's vertices 1 and 2
        bool back_face = false;  ///< the back was hit, of a one-sided or two-sided surface
    };
    struct Ray {
        Vec3 origin;
        Vec3 direction;      ///< unit
        float farthest = 0;  ///< maximum distance of a hit; may be infinite
    };
    void closest(std::span<const Ray> rays, std::span<Hit> out) const;
    /// Returns whether a surface blocks light on the ray; backs of one-sided surfaces do not, even if a front
    /// coincides.
    [[nodiscard]] bool stops(const Ray& ray) const;

    /// Returns whether the scene has light: a source, or an environment that is not black.
    [[nodiscard]] bool has_light() const;
    /// Returns the number of rays traced with this scratch: closest hits and shadow rays.
    [[nodiscard]] static std::uint64_t rays(const Scratch& scratch);
    [[nodiscard]] const World& world() const;
    [[nodiscard]] const Scene& scene() const;
    [[nodiscard]] const PathOptions& options() const;
    /// Returns the offset [m] by which a ray's origin must leave a surface at `position` so as not to hit it again.
    [[nodiscard]] float lift(Vec3 position) const;

  private:
    struct Implementation;
    std::unique_ptr<const Implementation> implementation_;
};

}  // namespace lobelia
