// Collects what the report of a bake shows from a bake in memory.
#include <fmt/format.h>

#include "bake/solve/page_irradiance.h"
#include "report/bake_report.h"

namespace lobelia {

std::vector<std::pair<std::string, std::string>> bake_settings(const BakeOptions& options, std::size_t pages) {
    std::vector<std::pair<std::string, std::string>> facts;
    facts.emplace_back("codec", options.codec.empty() ? "none: irradiance alone" : options.codec);
    if (!options.codec.empty()) facts.emplace_back("frame", options.frame == Frame::world ? "world" : "tangent");
    facts.emplace_back("pages", fmt::format("{} × {} × {}", pages, options.atlas.width, options.atlas.height));
    if (options.atlas.texels_per_metre)
        facts.emplace_back("texels per metre", fmt::format("{:g}", *options.atlas.texels_per_metre));
    facts.emplace_back("samples", fmt::format("{}", options.samples));
    if (options.target_error) facts.emplace_back("target error", fmt::format("{:g} %", 100 * *options.target_error));
    facts.emplace_back("bounces", fmt::format("{}", options.paths.bounces));
    facts.emplace_back("directions", options.directions == DirectionChoice::uniform ? "uniform" : "half by the cosine");
    facts.emplace_back("seed", fmt::format("{}", options.paths.seed));
    return facts;
}

BakeReport bake_report_of(const Scene& scene, const Baker& baker, const Bake& bake) {
    BakeReport page;
    page.title = scene.name;
    page.settings = bake_settings(bake.manifest.options, bake.pages.size());
    page.statistics = baker.statistics();
    page.light = {bake.pages, baker.atlas().placements(), bake.layout(), baker.codec(), baker.in_tangent_frame()};
    const Frame frame = baker.in_tangent_frame() ? Frame::tangent : Frame::world;
    for (std::size_t p = 0; baker.codec() != nullptr && p < bake.pages.size(); ++p)
        page.codec_irradiance.push_back(
            page_irradiance(bake.pages[p], bake.layout(), bake.normals[p], frame, baker.codec()->evaluator()));
    page.object_of_chart = objects_of_charts(baker.atlas());
    page.objects = object_figures(scene, page.light, page.object_of_chart, page.codec_irradiance);
    if (bake.probes)
        if (const auto codec = make_codec(bake.probes->codec)) page.probes = view_probes(*bake.probes, *codec);
    return page;
}

}  // namespace lobelia
