// Results of preflight, for the report of a bake.
#include <fmt/format.h>

#include <cmath>

#include "bake/preflight/preflight.h"
#include "io/counted.h"
#include "report/bake_report.h"

namespace lobelia {
namespace {

/// A sentence such as "3 triangles of 'wall': they get no texels" as a name and a text.
PreflightCheck check_of(const std::string& sentence) {
    const std::size_t colon = sentence.find(": ");
    if (colon == std::string::npos) return {PreflightCheck::Level::warning, sentence, ""};
    return {PreflightCheck::Level::warning, sentence.substr(0, colon), sentence.substr(colon + 2)};
}

std::string mebibytes(std::size_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20)); }

Image as_linear_values(const Image8& picture) {
    Image image(picture.width, picture.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto channel = [&](std::size_t k) { return static_cast<float>(picture.rgb[3 * i + k]) / 255; };
        image.pixels[i] = {channel(0), channel(1), channel(2)};
    }
    return image;
}

}  // namespace

void add_preflight(BakeReport& report, const Preflight& preflight, const Scene& scene) {
    using Level = PreflightCheck::Level;
    const auto sentences = warnings(preflight, scene);
    for (const std::string& sentence : sentences) report.checks.push_back(check_of(sentence));
    if (sentences.empty()) report.checks.push_back({Level::good, "Lightmap UVs", "no problems"});

    const double texels = static_cast<double>(preflight.width * preflight.height * preflight.pages.size());
    report.checks.push_back(
        {Level::note, "Charts",
         fmt::format("{} on {} page{}, covering {:.1f} % of the texels", preflight.charts, preflight.pages.size(),
                     preflight.pages.size() == 1 ? "" : "s", 100 * static_cast<double>(preflight.texels) / texels)});
    const BakeMemory& memory = preflight.memory;
    report.checks.push_back({Level::note, "Memory",
                             fmt::format("{}: scene {}, states {}, pages {}, finishing {}", mebibytes(memory.total()),
                                         mebibytes(memory.scene), mebibytes(memory.states), mebibytes(memory.pages),
                                         mebibytes(memory.finishing))});
    if (!preflight.density.share.empty())
        report.checks.push_back(
            {Level::note, "Density",
             fmt::format("{:.3g} to {:.3g} texels per metre, median {:.3g}", preflight.density.least,
                         preflight.density.most, preflight.density.median)});
    for (std::size_t i = 0; i < preflight.density.share.size(); ++i)
        report.density.emplace_back(preflight.density.first * std::exp2(static_cast<double>(i) / 2),
                                    preflight.density.share[i]);

    constexpr std::size_t k_most_side = 768;
    for (std::size_t p = 0; p < preflight.pages.size(); ++p)
        report.preflight_pictures.push_back({fmt::format("Page {}: charts; orange: too close; red: overlapping", p),
                                             as_linear_values(preflight_picture(preflight, p, k_most_side))});
}

}  // namespace lobelia
