// Resolves camera rays to the first surface visible through transparent ones.
#pragma once

#include <span>
#include <vector>

#include "trace/path_tracer.h"
#include "trace/surface.h"

namespace lobelia {

/// Generates the rays of a camera. Sample s of pixel (x, y) has the key y * width + x; its position within the pixel is
/// point s of that key's first sequence: uniform over the pixel's square, and well distributed for any number of
/// samples.
class CameraRays {
  public:
    CameraRays(const Camera& camera, std::size_t width, std::size_t height, std::uint32_t seed);
    [[nodiscard]] PathStart ray(std::size_t pixel, std::uint32_t sample) const;

  private:
    Vec3 origin_, corner_, right_, down_;
    std::size_t width_;
    std::uint32_t seed_;
};

/// The end of a camera ray.
struct Sight {
    enum class Kind {
        paths,  ///< to be shaded by PathTracer::trace from `start`
        unlit,  ///< a surface shown as its base colour
        baked   ///< the front of a surface that has a lightmap
    };
    Kind kind = Kind::paths;
    PathStart start;      ///< behind the transparent surfaces that the ray passed
    PathTracer::Hit hit;  ///< if the kind is unlit or baked
};

/// Resolves camera rays to the first surface visible through transparent ones.
class CameraView {
  public:
    /// `baked` has one entry per object: nonzero if its front faces have a lightmap.
    CameraView(const PathTracer& tracer, std::vector<std::uint8_t> baked);

    /// Resolves each ray. Blended surfaces let rays pass at random; the decision depends only on key and sample, and is
    /// the path tracer's.
    void resolve(std::span<const PathStart> rays, std::span<Sight> out) const;

    [[nodiscard]] const Surfaces& surfaces() const { return surfaces_; }
    /// Returns the base colour of an unlit surface.
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
