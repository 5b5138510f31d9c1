// Renders a bake beside its reference: the same cameras, the same pixels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/render/render.h"
#include "lobelia/image.h"
#include "lobelia/scene.h"

namespace lobelia {

/// One camera: pictures of the same pixels, linear radiance.
struct BakeView {
    std::string camera;
    Image baked, reference;
    std::uint32_t reference_samples = 0;  ///< of each pixel
};

/// Renders the first `most` cameras of the scene, or the default one: lit by the bake, and path-traced with the bake's
/// options. Returns nothing if options.stop was set on the way.
[[nodiscard]] std::optional<std::vector<BakeView>> render_views(const Scene& scene, const BakedLight& light,
                                                                const PathOptions& paths, const RenderOptions& options,
                                                                std::size_t most = 4);

}  // namespace lobelia
