// Pictures from a camera: the ground truth by paths, and what a bake makes of the same scene, pixel by pixel alike.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "bake/place/atlas.h"
#include "bake/solve/pages.h"
#include "lobelia/codec.h"
#include "lobelia/image.h"
#include "trace/path_tracer.h"

namespace lobelia {

struct RenderOptions {
    std::size_t width = 960, height = 600;  ///< at least 1, and at most 2^32 pixels in all
    std::uint32_t samples = 64;             ///< of each pixel, over its square
    unsigned threads = 0;                   ///< 0: all processors
    const std::atomic<bool>* stop = nullptr;
    std::function<void(double)> progress = {};  ///< told the share that is done; one call at a time
};

/// Radiance [W/(m^2 sr)] by path tracing: of each pixel the mean over samples of PathTracer::trace, what is emitted and
/// what is scattered. The camera sees a surface before light meets any, so that for a picture to hold a bake with B
/// bounces against, the tracer needs B + 1. Unlit surfaces show their base colour. The same bits for any number of
/// threads; nothing where `stop` was set on the way.
[[nodiscard]] std::optional<Image> render_paths(const PathTracer& tracer, const Camera& camera,
                                                const RenderOptions& options = {});

/// A bake's pages and what reads them.
struct BakedLight {
    std::span<const Page> pages;
    std::span<const AtlasPlacement> placements;  ///< of each object
    PageLayout layout;
    const Codec* codec = nullptr;   ///< null: pages hold irradiance alone
    bool in_tangent_frame = false;  ///< directions of the coefficients are in each texel's tangent frame
};

/// The same camera rays, but where they meet the front of a surface with a lightmap, its light is that of the pages:
/// coefficients, interpolated bilinearly, read as irradiance at the shading normal for the diffuse part, and as
/// radiance in one direction of the glossy lobe for each sample. What the pages do not hold (the background, objects
/// without lightmap UVs, backs of double-sided surfaces) is traced as in render_paths.
/// Precondition: one placement for each object of the tracer's scene, on pages that are there.
[[nodiscard]] std::optional<Image> render_bake(const PathTracer& tracer, const BakedLight& light, const Camera& camera,
                                               const RenderOptions& options = {});

/// The camera that sees all of `world` from the front and a little above, for scenes that bring none.
[[nodiscard]] Camera default_camera(const World& world);

}  // namespace lobelia
