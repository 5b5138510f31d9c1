// Computes the denoiser's guides: the surface at each texel.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "bake/finish/finish.h"

namespace lobelia {

Guides make_guides(const Atlas& atlas, const TexelMap& map, StopFlag stop) {
    Guides guides;
    guides.position.assign(atlas.pages(), std::vector<Vec3>(atlas.width() * atlas.height()));
    guides.normal = guides.position;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, map.texels.size(), 4096), [&](const auto& range) {
        stop.check();
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const CoveredTexel& texel = map.texels[i];
            const TexelSurface point = surface_of(atlas, map, i);
            const std::size_t place = texel.y * atlas.width() + texel.x;
            guides.position[texel.page][place] = point.position;
            guides.normal[texel.page][place] = point.normal;
        }
    });
    return guides;
}

}  // namespace lobelia
