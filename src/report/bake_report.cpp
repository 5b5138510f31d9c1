// The page of a bake, put together.
#include "report/bake_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/bake_layers.h"
#include "report/page_template.h"

namespace lobelia {
namespace {

using Json = nlohmann::json;

Json to_json(const BakeStatistics& s, bool has_codec) {
    Json json = {{"texels", s.texels},
                 {"invalid_texels", s.invalid_texels},
                 {"buried_texels", s.buried_texels},
                 {"rays", s.rays},
                 {"seconds", s.seconds},
                 {"samples", s.samples},
                 {"mean_error", s.mean_error},
                 {"back_face_share", s.back_face_share}};
    if (has_codec) {
        json["codec_error"] = s.codec_error;
        json["negative_share"] = s.negative_share;
        json["ringing"] = s.ringing;
    }
    return json;
}

Json to_json(const ObjectFigures& object, bool has_codec) {
    Json json = {{"name", object.name},
                 {"texels", object.texels},
                 {"invalid", object.invalid},
                 {"irradiance", {object.irradiance.r, object.irradiance.g, object.irradiance.b}},
                 {"standard_error", object.standard_error}};
    if (has_codec) json["codec_error"] = object.codec_error;
    if (object.texels > 0)
        json["box"] = {{"page", object.page},
                       {"x0", object.box.x0},
                       {"y0", object.box.y0},
                       {"x1", object.box.x1},
                       {"y1", object.box.y1}};
    return json;
}

const char* level_name(PreflightCheck::Level level) {
    switch (level) {
        case PreflightCheck::Level::good:
            return "good";
        case PreflightCheck::Level::note:
            return "note";
        case PreflightCheck::Level::warning:
            return "warning";
        default:
            return "bad";
    }
}

Picture encode(const Image& image) { return encode_picture(std::span(image.pixels), image.width, image.height); }

/// Pictures go to `pictures`, and their names into the JSON.
Json views_of(const BakeReport& bake, std::map<std::string, Picture>& pictures) {
    Json views = Json::array();
    for (std::size_t i = 0; i < bake.views.size(); ++i) {
        const BakeView& view = bake.views[i];
        const std::string baked = fmt::format("view {} baked", i), reference = fmt::format("view {} reference", i);
        pictures[baked] = encode(view.baked);
        pictures[reference] = encode(view.reference);
        views.push_back(
            {{"camera", view.camera}, {"samples", view.reference_samples}, {"baked", baked}, {"reference", reference}});
    }
    return views;
}

Json preflight_of(const BakeReport& bake, std::map<std::string, Picture>& pictures) {
    Json checks = Json::array(), shown = Json::array();
    for (const PreflightCheck& check : bake.checks)
        checks.push_back({{"level", level_name(check.level)}, {"name", check.name}, {"text", check.text}});
    for (std::size_t i = 0; i < bake.preflight_pictures.size(); ++i) {
        const std::string name = fmt::format("preflight {}", i);
        pictures[name] = encode(bake.preflight_pictures[i].image);
        shown.push_back({{"title", bake.preflight_pictures[i].title}, {"name", name}});
    }
    return {{"checks", std::move(checks)}, {"pictures", std::move(shown)}, {"density", bake.density}};
}

Json probes_of(const ProbeView& probes, std::map<std::string, Picture>& pictures) {
    Json plans = Json::array();
    for (std::size_t i = 0; i < probes.plans.size(); ++i) {
        const ProbePlan& plan = probes.plans[i];
        const std::string name = fmt::format("probes {}", i), marks = fmt::format("probes {} marks", i);
        pictures[name] = encode(plan.image);
        pictures[marks] = encode_picture(plan.marks, plan.image.width, plan.image.height);
        plans.push_back({{"height", plan.height}, {"count", plan.count}, {"name", name}, {"marks", marks}});
    }
    return {{"codec", probes.codec},
            {"count", probes.count},
            {"invalid", probes.invalid},
            {"heights", probes.heights},
            {"plans", std::move(plans)}};
}

/// Mean luminance of E over the texels that were baked.
double mean_irradiance(const BakeReport& bake) {
    double sum = 0, count = 0;
    const PageChannels& channels = bake.light.channels;
    for (const LightmapPage& page : bake.light.pages)
        for (std::size_t i = 0; i < page.size(); ++i) {
            if (page.chart[i] == 0) continue;
            const auto plane = [&](std::size_t k) { return page.planes[channels.irradiance(k)][i]; };
            sum += static_cast<double>(luminance({plane(0), plane(1), plane(2)}));
            count += 1;
        }
    return count > 0 ? sum / count : 0;
}

}  // namespace

std::string bake_html(const BakeReport& bake, const BakeReportOptions& options) {
    const bool has_codec = bake.light.codec.has_value();
    BakeLayers layers = bake_layers(bake, options);
    std::map<std::string, Picture>& pictures = layers.pictures;
    Json pages = Json::array(), objects = Json::array(), settings = Json::array();
    for (const LightmapPage& page : bake.light.pages) pages.push_back({{"width", page.width}, {"height", page.height}});
    for (const ObjectFigures& object : bake.objects) objects.push_back(to_json(object, has_codec));
    for (const auto& [name, value] : bake.settings) settings.push_back({name, value});
    Json data = {{"lobelia", LOBELIA_VERSION},
                 {"title", bake.title},
                 {"settings", std::move(settings)},
                 {"warnings", bake.warnings},
                 {"views", views_of(bake, pictures)},
                 {"pages", std::move(pages)},
                 {"layers", layers.layers},
                 {"mean_irradiance", mean_irradiance(bake)},
                 {"object_of_chart", bake.object_of_chart},
                 {"objects", std::move(objects)},
                 {"preflight", preflight_of(bake, pictures)}};
    if (bake.probes) data["probes"] = probes_of(*bake.probes, pictures);
    if (bake.statistics) data["statistics"] = to_json(*bake.statistics, has_codec);

    const std::string text = script_safe(data);
    return fill_template("bake/bake.html", text.size() + written_bytes(pictures),
                         [&](std::string_view mark, std::string& html) {
                             if (mark == "bake")
                                 html += text;
                             else if (mark == "pictures")
                                 write_pictures(pictures, html);
                             else
                                 return false;
                             return true;
                         });
}

}  // namespace lobelia
