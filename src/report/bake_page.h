// The page of a bake: the scene as it looks beside the truth, its lightmaps, its figures. One file that opens offline.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bake/render/render.h"
#include "lobelia/image.h"
#include "report/bake_probes.h"

namespace lobelia {

/// One camera: pictures of the same pixels, linear radiance.
struct BakeView {
    std::string camera;
    Image baked, truth;
    std::uint32_t truth_samples = 0;  ///< of each pixel
};

/// What an object's texels came to; those that are invalid are counted and left out of the means.
struct ObjectFigures {
    std::string name;
    std::size_t texels = 0, invalid = 0;
    Rgb irradiance;             ///< mean E [W/m^2]
    double standard_error = 0;  ///< RMS of the standard error of E's luminance, over the mean
    double codec_error = 0;     ///< RMS of E by the codec minus E by the paths (luminance), over the mean
    std::uint32_t page = 0;     ///< where its texels are,
    TexelBox box;               ///< and the smallest box about them
};

/// One line of what was looked at before the bake.
struct PreflightCheck {
    enum class Level { good, note, warning, bad } level = Level::good;
    std::string name, text;
};
/// A picture ready for the screen: values in [0, 1] of sRGB.
struct PreflightPicture {
    std::string title;
    Image image;
};

/// All that the page shows; what is empty is left out.
struct BakeReport {
    std::string title;
    std::vector<std::pair<std::string, std::string>> settings;  ///< names and values, as bake_settings gives them
    std::optional<BakeStatistics> statistics;
    std::vector<std::string> warnings;
    std::vector<BakeView> views;
    BakedLight light;                                ///< the pages
    std::vector<std::vector<Rgb>> codec_irradiance;  ///< of each page, as page_irradiance gives it
    std::vector<std::uint32_t> object_of_chart;      ///< Preflight::object_of_chart
    std::vector<ObjectFigures> objects;              ///< in the scene's order, as object_figures gives them
    std::optional<ProbeView> probes;
    std::vector<PreflightCheck> checks;
    std::vector<PreflightPicture> preflight_pictures;
    std::vector<std::pair<double, double>> density;  ///< texels per metre, from so many on: share of the area
};

/// What a reader wants to know of a bake's options.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> bake_settings(const BakeOptions& options,
                                                                             std::size_t pages);
/// One entry for each object of the scene; names are those of `scene`. `codec_irradiance` may be empty.
[[nodiscard]] std::vector<ObjectFigures> object_figures(const Scene& scene, const BakedLight& light,
                                                        std::span<const std::uint32_t> object_of_chart,
                                                        std::span<const std::vector<Rgb>> codec_irradiance);

/// Everything but views and preflight of a bake, which must outlive the result. An error if its codec is unknown.
[[nodiscard]] Result<BakeReport> bake_page_of(const Scene& scene, const Bake& bake);

/// The scene from each of its cameras, or the default one, at most `most`: lit by the bake and path-traced with the
/// bake's options. Nothing where options.stop was set on the way.
[[nodiscard]] std::optional<std::vector<BakeView>> render_views(const Scene& scene, const BakedLight& light,
                                                                const PathOptions& paths, const RenderOptions& options,
                                                                std::size_t most = 4);

/// Adds the results of a preflight: checks, densities, a picture of each page.
void add_preflight(BakeReport& page, const Preflight& preflight, const Scene& scene);

struct BakeReportOptions {
    std::size_t most_layer_bytes = std::size_t{24} << 20;  ///< of the lightmaps' pictures; larger ones are reduced
};

/// The HTML: CSS, scripts, pictures and data are inside, and it loads nothing. Whatever strings the bake holds cannot
/// end the element that they are in.
[[nodiscard]] std::string bake_html(const BakeReport& bake, const BakeReportOptions& options = {});

/// Renders the scene from its cameras, and makes the whole report of a bake. An error if pictures.stop was set.
[[nodiscard]] Result<std::string> bake_report(const Scene& scene, const Bake& bake, const ReportOptions& options,
                                              const RenderOptions& pictures = {});

}  // namespace lobelia
