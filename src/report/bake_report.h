// The report of a bake: the scene lit by the bake beside the path-traced reference, its lightmaps, its figures. One
// HTML file that opens offline.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/render/render.h"
#include "core/stop.h"
#include "lobelia/image.h"
#include "measure/bake_figures.h"
#include "measure/bake_views.h"
#include "report/bake_probes.h"

namespace lobelia {

/// One result of the checks made before the bake.
struct PreflightCheck {
    enum class Level { good, note, warning, bad } level = Level::good;
    std::string name, text;
};
/// A picture ready for the screen: values in [0, 1] of sRGB.
struct PreflightPicture {
    std::string title;
    Image image;
};

/// Everything that the report shows; empty parts are left out.
struct BakeReport {
    std::string title;
    std::vector<std::pair<std::string, std::string>> settings;  ///< names and values, as bake_settings gives them
    std::optional<BakeStatistics> statistics;
    std::vector<std::string> warnings;
    std::vector<BakeView> views;
    BakedLight light;                                ///< the lightmap pages
    std::vector<std::vector<Rgb>> codec_irradiance;  ///< of each page, as page_irradiance gives it
    std::vector<std::uint32_t> object_of_chart;      ///< Preflight::object_of_chart
    std::vector<ObjectFigures> objects;              ///< in the scene's order, as object_figures gives them
    std::optional<ProbeView> probes;
    std::vector<PreflightCheck> checks;
    std::vector<PreflightPicture> preflight_pictures;
    std::vector<std::pair<double, double>> density;  ///< lower end of a range [texels per metre], share of the area
};

/// Names and values of a bake's options, for the report's header.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> bake_settings(const BakeOptions& options,
                                                                             std::size_t pages);
/// Everything but views and preflight of a bake, which must outlive the result. Error: its codec is unknown.
/// Throws Stopped.
[[nodiscard]] Result<BakeReport> bake_report_of(const Scene& scene, const Bake& bake, StopFlag stop = {});

/// Adds the results of a preflight: checks, densities, a picture of each page.
void add_preflight(BakeReport& report, const Preflight& preflight, const Scene& scene);

struct BakeReportOptions {
    std::size_t most_layer_bytes = std::size_t{24} << 20;  ///< of the lightmaps' pictures; larger ones are reduced
    StopFlag stop = {};                                    ///< Stopped is thrown
};

/// The HTML: CSS, scripts, pictures and data are inside, and it loads nothing. Whatever strings the bake holds cannot
/// end the element that they are in.
[[nodiscard]] std::string bake_html(const BakeReport& bake, const BakeReportOptions& options = {});

/// Renders the scene from its cameras, and makes the whole report of a bake. Error: pictures.stop was set.
[[nodiscard]] Result<std::string> bake_report(const Scene& scene, const Bake& bake, const ReportOptions& options,
                                              const RenderOptions& pictures = {});

}  // namespace lobelia
