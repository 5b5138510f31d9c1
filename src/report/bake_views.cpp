// What the page of a bake shows of a bake that is in memory.
#include <algorithm>

#include "bake/solve/page_irradiance.h"
#include "report/bake_page.h"

namespace lobelia {

Result<BakeReport> bake_page_of(const Scene& scene, const Bake& bake) {
    auto light = light_of(bake);
    if (!light) return light.error();
    BakeReport page;
    page.title = scene.name;
    page.settings = bake_settings(bake.manifest.options, bake.pages.size());
    page.statistics = bake.manifest.statistics;
    page.warnings = bake.manifest.warnings;
    page.light = *std::move(light);
    for (std::size_t p = 0; page.light.codec && p < bake.pages.size(); ++p)
        page.codec_irradiance.push_back(page_irradiance(bake.pages[p], bake.channels(), bake.normals[p],
                                                        page.light.frame, page.light.codec->evaluator()));
    if (bake.preflight) page.object_of_chart = bake.preflight->object_of_chart;
    page.objects = object_figures(scene, page.light, page.object_of_chart, page.codec_irradiance);
    if (bake.probes)
        if (const auto codec = make_codec(bake.probes->codec)) page.probes = view_probes(*bake.probes, *codec);
    return page;
}

std::optional<std::vector<BakeView>> render_views(const Scene& scene, const BakedLight& light, const PathOptions& paths,
                                                  const RenderOptions& options, std::size_t most) {
    const World world = make_world(scene);
    PathOptions with_seen_surface = paths;
    with_seen_surface.bounces += 1;
    const PathTracer tracer(scene, world, with_seen_surface);
    std::vector<Camera> cameras = scene.cameras;
    if (cameras.empty()) cameras.push_back(default_camera(world));
    cameras.resize(std::min(cameras.size(), most));

    // The truth takes nearly all of the time.
    std::vector<BakeView> views;
    for (const Camera& camera : cameras) {
        RenderOptions of_view = options;
        const auto before = static_cast<double>(views.size()), all = static_cast<double>(cameras.size());
        of_view.progress = [&](double done) {
            if (options.progress) options.progress((before + done) / all);
        };
        auto truth = render_paths(tracer, camera, of_view);
        of_view.progress = {};
        auto baked = truth ? render_bake(tracer, light, camera, of_view) : std::nullopt;
        if (!baked) return std::nullopt;
        views.push_back({camera.name, *std::move(baked), *std::move(truth), options.samples});
    }
    return views;
}

Result<std::string> bake_report(const Scene& scene, const Bake& bake, const ReportOptions& options,
                                const RenderOptions& pictures) {
    auto page = bake_page_of(scene, bake);
    if (!page) return page.error();
    if (bake.preflight) add_preflight(*page, *bake.preflight, scene);
    RenderOptions of_pictures = pictures;
    of_pictures.width = options.width;
    of_pictures.height = options.height;
    of_pictures.samples = options.samples;
    auto views = render_views(scene, page->light, bake.manifest.options.paths, of_pictures);
    if (!views) return Error{"stopped"};
    page->views = std::move(*views);
    return bake_html(*page);
}

}  // namespace lobelia
