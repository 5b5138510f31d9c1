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

Result<BakeReport> bake_report_of(const Scene& scene, const Bake& bake) {
    auto light = light_of(bake);
    if (!light) return light.error();
    BakeReport report;
    report.title = scene.name;
    report.settings = bake_settings(bake.manifest.options, bake.pages.size());
    report.statistics = bake.manifest.statistics;
    report.warnings = bake.manifest.warnings;
    report.light = *std::move(light);
    for (std::size_t p = 0; report.light.codec && p < bake.pages.size(); ++p)
        report.codec_irradiance.push_back(page_irradiance(bake.pages[p], bake.channels(), bake.normals[p],
                                                          report.light.frame, report.light.codec->evaluator()));
    if (bake.preflight) report.object_of_chart = bake.preflight->object_of_chart;
    report.objects = object_figures(scene, report.light, report.object_of_chart, report.codec_irradiance);
    if (bake.probes)
        if (const auto codec = make_codec(bake.probes->codec)) report.probes = view_probes(*bake.probes, *codec);
    return report;
}

Result<std::string> bake_report(const Scene& scene, const Bake& bake, const ReportOptions& options,
                                const RenderOptions& pictures) {
    auto report = bake_report_of(scene, bake);
    if (!report) return report.error();
    if (bake.preflight) add_preflight(*report, *bake.preflight, scene);
    RenderOptions of_pictures = pictures;
    of_pictures.width = options.width;
    of_pictures.height = options.height;
    of_pictures.samples = options.samples;
    auto views = render_views(scene, report->light, bake.manifest.options.paths, of_pictures);
    if (!views) return Error{"stopped", Error::Kind::stopped};
    report->views = std::move(*views);
    return bake_html(*report);
}

}  // namespace lobelia
