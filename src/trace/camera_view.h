// What a camera's rays meet first: the surface that a person sees there, behind all that lets the ray through.
#pragma once

#include <span>
#include <vector>

#include "trace/path_tracer.h"
#include "trace/surface.h"

namespace lobelia {

/// The rays of a camera's picture. Sample s of pixel (x, y) has the key y * width + x, and its place within the pixel
/// is point s of that key's first sequence: uniform over the pixel's square, and well spread for any number of samples.
class CameraRays {
  public:
    CameraRays(const Camera& camera, std::size_t width, std::size_t height, std::uint32_t seed);
    [[nodiscard]] PathStart ray(std::size_t pixel, std::uint32_t sample) const;

  private:
    Vec3 origin_, corner_, right_, down_;
    std::size_t width_;
    std::uint32_t seed_;
};

/// Where a ray ends for a person.
struct Sight {
    enum class Kind {
        paths,  ///< whatever is there, PathTracer::trace tells it from `start`
        unlit,  ///< a surface that is shown as its base colour
        baked   ///< the front of a surface that has a lightmap
    };
    Kind kind = Kind::paths;
    PathStart start;      ///< beyond the surfaces that let the ray through
    PathTracer::Hit hit;  ///< of unlit and baked
};

/// Finds them.
class CameraView {
  public:
    /// `baked`: of each object, whether its fronts count as baked.
    CameraView(const PathTracer& tracer, std::vector<std::uint8_t> baked);

    /// One sight for each ray. Surfaces that blend let rays through by chance, always the same for the same key and
    /// sample, and the same as the path tracer's.
    void look(std::span<const PathStart> rays, std::span<Sight> out) const;

    [[nodiscard]] const Surfaces& surfaces() const { return surfaces_; }
    /// The colour of an unlit surface.
    [[nodiscard]] Rgb unlit_color(const PathTracer::Hit& hit) const;

  private:
    enum class Meets { stops, passes };
    [[nodiscard]] Meets meet(const PathTracer::Hit& hit, std::uint32_t salt, Sight::Kind& kind) const;

    const PathTracer* tracer_;
    std::vector<std::uint8_t> baked_;
    Surfaces surfaces_;
    bool more_than_paths_ = false;
};

}  // namespace lobelia
