// What arrives at a point from all around.
#pragma once

#include "lobelia/bake_job.h"
#include "lobelia/environment.h"

namespace lobelia {

/// Path-traces the radiance at a position as a latitude-longitude image, the mean of `samples` paths a texel, spread
/// over it. An error if `options.stop` was set. Also tells how much of the view is inside of things: the share of
/// directions that meet a back face first.
struct ViewAround {
    Image radiance;
    double back_faces = 0;
};
[[nodiscard]] Result<ViewAround> render_around(const Scene& scene, Vec3 position, LatLong size,
                                               const PathOptions& paths, const RenderOptions& options);

}  // namespace lobelia
