// Renders every camera twice.
#include "measure/bake_views.h"

#include <algorithm>

namespace lobelia {

std::optional<std::vector<BakeView>> render_views(const Scene& scene, const BakedLight& light, const PathOptions& paths,
                                                  const RenderOptions& options, std::size_t most) {
    const World world = make_world(scene);
    PathOptions with_seen_surface = paths;
    with_seen_surface.bounces += 1;
    const PathTracer tracer(scene, world, with_seen_surface);
    std::vector<Camera> cameras = scene.cameras;
    if (cameras.empty()) cameras.push_back(default_camera(world));
    cameras.resize(std::min(cameras.size(), most));

    // The reference takes nearly all of the time.
    std::vector<BakeView> views;
    for (const Camera& camera : cameras) {
        RenderOptions of_view = options;
        const auto before = static_cast<double>(views.size()), all = static_cast<double>(cameras.size());
        of_view.progress = [&](double done) {
            if (options.progress) options.progress((before + done) / all);
        };
        auto reference = render_paths(tracer, camera, of_view);
        of_view.progress = {};
        auto baked = reference ? render_bake(tracer, light, camera, of_view) : std::nullopt;
        if (!baked) return std::nullopt;
        views.push_back({camera.name, *std::move(baked), *std::move(reference), options.samples});
    }
    return views;
}

}  // namespace lobelia
