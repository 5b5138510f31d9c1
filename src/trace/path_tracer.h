// Light transport: what radiance arrives along a ray, and what arrives at a point straight from the light sources.
// Kajiya 1986 (the equation); Veach 1997 (multiple importance sampling); Walter et al. 2007, Heitz 2018 (GGX).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "lobelia/render.h"
#include "scene/world.h"

namespace lobelia {

/// Where a path begins, and which it is: `key` names the receiver (texel, probe or pixel), `sample` the point of its
/// Owen-scrambled Sobol sequences (Burley 2020). The same key, sample and seed give the same path.
struct PathStart {
    Vec3 origin;
    Vec3 direction;  ///< unit, the way one looks
    std::uint32_t key = 0;
    std::uint32_t sample = 0;
};

/// What arrives along a ray.
struct Incident {
    Rgb scattered;           ///< radiance from there that has met a surface at least once [W/(m^2 sr)]
    Rgb emitted;             ///< radiance of the source that the ray meets first, environment included
    float source_pdf = 0;    ///< density [1/sr] with which `direct` would have chosen this direction; 0: never
    float distance = 0;      ///< to the first surface that stops light, or that back face [m]; infinite: none
    bool back_face = false;  ///< the first surface shows its back, and it is a one-sided material: a leak
};

/// One light source as it reaches a point: a direction, and irradiance across it.
struct DirectLight {
    Vec3 direction;  ///< towards the source, unit
    Rgb irradiance;  ///< L / pdf, or that of a light without size, on a surface that faces it [W/m^2]; 0: hidden, none
    float pdf = 0;   ///< of the direction [1/sr]; 0 where only `direct` can find this light (it has no size)
};

/// Immutable; shared between threads, each with a scratch of its own.
class PathTracer {
  public:
    class Scratch;
    /// Builds the acceleration structure and the tables of light sources. Throws Stopped.
    PathTracer(const Scene& scene, const World& world, const PathOptions& options = {}, StopFlag stop = {});
    ~PathTracer();
    PathTracer(const PathTracer&) = delete;
    PathTracer& operator=(const PathTracer&) = delete;

    [[nodiscard]] std::unique_ptr<Scratch, void (*)(Scratch*)> make_scratch() const;

    /// Follows each path; `out` has one entry for each. Any number at a time; a few hundred fill the machine.
    /// `normals` (one each, or none) are those that `direct` is given for the same starts: `source_pdf` depends on
    /// them.
    void trace(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<Incident> out,
               Scratch& scratch) const;
    void trace(std::span<const PathStart> starts, std::span<Incident> out, Scratch& scratch) const {
        trace(starts, {}, out, scratch);
    }

    /// One light source for each start (its direction is ignored), chosen in proportion to power and, roughly,
    /// distance; lights below the plane through the origin with `normal` are not chosen where normals are given (one
    /// each, or none). Nothing where next_event is off. As receivers may not see the backs of one-sided surfaces, these
    /// hide the light.
    void direct(std::span<const PathStart> starts, std::span<const Vec3> normals, std::span<DirectLight> out,
                Scratch& scratch) const;

    /// Closest hits without shading, for whoever asks about the geometry. Every surface counts, whatever its material.
    struct Hit {
        float distance = 0;  ///< infinite: none
        std::uint32_t triangle = 0;
        float u = 0, v = 0;      ///< barycentric weights of the triangle's vertices 1 and 2
        bool back_face = false;  ///< it shows its back, be it one-sided or not
    };
    struct Ray {
        Vec3 origin;
        Vec3 direction;      ///< unit
        float farthest = 0;  ///< no hit beyond; infinite: anywhere
    };
    void closest(std::span<const Ray> rays, std::span<Hit> out) const;
    /// Whether a surface stops light on the ray: backs of one-sided surfaces do not, whatever lies at the same place.
    [[nodiscard]] bool stops(const Ray& ray) const;

    /// Whether there is any light at all: a source, or an environment that is not black.
    [[nodiscard]] bool has_light() const;
    /// Rays traced so far with this scratch: closest hits and shadow rays.
    [[nodiscard]] static std::uint64_t rays(const Scratch& scratch);
    [[nodiscard]] const World& world() const;
    [[nodiscard]] const Scene& scene() const;
    [[nodiscard]] const PathOptions& options() const;
    /// By how much to lift a ray's origin off a surface at `position` so that it does not meet it again [m].
    [[nodiscard]] float lift(Vec3 position) const;

  private:
    struct Implementation;
    std::unique_ptr<const Implementation> implementation_;
};

}  // namespace lobelia
