// The report of a bake: the scene lit by the bake beside the path-traced reference, its lightmaps, its figures. One
// HTML file that opens offline.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/baker.h"
#include "bake/render/render.h"
#include "bake/session/preflight.h"
#include "bake/write/bake_folder.h"
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
    std::vector<std::uint32_t> object_of_chart;      ///< as objects_of_charts gives it
    std::vector<ObjectFigures> objects;              ///< in the scene's order, as object_figures gives them
    std::optional<ProbeView> probes;
    std::vector<PreflightCheck> checks;
    std::vector<PreflightPicture> preflight_pictures;
    std::vector<std::pair<double, double>> density;  ///< lower end of a range [texels per metre], share of the area
};

/// Names and values of a bake's options, for the report's header.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> bake_settings(const BakeOptions& options,
                                                                             std::size_t pages);
/// Everything but warnings, views and preflight of a bake in memory.
/// Preconditions: `baker` has run, `bake` is as it is written; both outlive the report.
[[nodiscard]] BakeReport bake_report_of(const Scene& scene, const Baker& baker, const Bake& bake);

/// Adds the results of preflight: checks, densities, a picture of each lightmap page.
void add_preflight(BakeReport& report, const Preflight& preflight, const Scene& scene, const Atlas& atlas,
                   const TexelMap& map);

struct BakeReportOptions {
    std::size_t most_layer_bytes = std::size_t{24} << 20;  ///< of the lightmaps' pictures; larger ones are reduced
};

/// The HTML: CSS, scripts, pictures and data are inside, and it loads nothing. Whatever strings the bake holds cannot
/// end the element that they are in.
[[nodiscard]] std::string bake_html(const BakeReport& bake, const BakeReportOptions& options = {});

}  // namespace lobelia
