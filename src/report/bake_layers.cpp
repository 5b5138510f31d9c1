// Reduces lightmap pages to pictures.
#include "report/bake_layers.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace lobelia {
namespace {

/// A page's size after reduction.
struct Extent {
    std::size_t width = 0, height = 0, factor = 1;
    Extent(const LightmapPage& page, std::size_t f)
        : width((page.width + f - 1) / f), height((page.height + f - 1) / f), factor(f) {}
    [[nodiscard]] std::size_t size() const { return width * height; }
};

/// Calls visit(texel index, reduced index) for each texel.
template <class Visit>
void for_each_texel(const LightmapPage& page, const Extent& to, const Visit& visit) {
    for (std::size_t y = 0; y < page.height; ++y)
        for (std::size_t x = 0; x < page.width; ++x)
            visit(y * page.width + x, y / to.factor * to.width + x / to.factor);
}

/// Means over the texels that belong to a chart, or where there is none, over those that were filled from others.
template <class Value, class ValueAt>
std::vector<Value> means(const LightmapPage& page, const Extent& to, const ValueAt& value_at) {
    std::vector<Value> charted(to.size()), filled(to.size());
    std::vector<std::uint32_t> charted_count(to.size()), filled_count(to.size());
    for_each_texel(page, to, [&](std::size_t i, std::size_t k) {
        const Value value = value_at(i);
        if (page.chart[i] != 0) {
            charted[k] = charted[k] + value;
            charted_count[k] += 1;
        } else if (value != Value{}) {
            filled[k] = filled[k] + value;
            filled_count[k] += 1;
        }
    });
    for (std::size_t k = 0; k < to.size(); ++k) {
        if (charted_count[k] > 0)
            charted[k] = charted[k] * (1 / static_cast<float>(charted_count[k]));
        else if (filled_count[k] > 0)
            charted[k] = filled[k] * (1 / static_cast<float>(filled_count[k]));
    }
    return charted;
}

/// The chart at the first texel of each square that has one; 16 bits of its number.
std::vector<std::uint16_t> charts(const LightmapPage& page, const Extent& to) {
    std::vector<std::uint16_t> result(to.size());
    for_each_texel(page, to, [&](std::size_t i, std::size_t k) {
        if (result[k] == 0) result[k] = static_cast<std::uint16_t>(std::min(page.chart[i], 0xffffu));
    });
    return result;
}

Rgb colour_of(const LightmapPage& page, std::size_t plane, std::size_t i) {
    return {page.planes[plane][i], page.planes[plane + 1][i], page.planes[plane + 2][i]};
}

/// Adds layers with pictures at one reduction.
class LayerWriter {
  public:
    LayerWriter(const BakeReport& bake, StopFlag stop, BakeLayers& out) : bake_(&bake), stop_(stop), out_(&out) {}

    /// `value_at(page number, texel)` gives an Rgb or a float.
    template <class Value, class ValueAt>
    void add(nlohmann::json layer, std::size_t factor, const ValueAt& value_at) {
        for (std::size_t p = 0; p < bake_->light.pages.size(); ++p) {
            stop_.check();
            const LightmapPage& page = bake_->light.pages[p];
            const Extent to(page, factor);
            const auto values = means<Value>(page, to, [&](std::size_t i) { return value_at(p, i); });
            keep(layer, p, encode_picture(std::span<const Value>(values), to.width, to.height));
        }
        out_->layers.push_back(std::move(layer));
    }
    void add_charts(nlohmann::json layer, std::size_t factor) {
        for (std::size_t p = 0; p < bake_->light.pages.size(); ++p) {
            const Extent to(bake_->light.pages[p], factor);
            keep(layer, p, encode_picture(charts(bake_->light.pages[p], to), to.width, to.height));
        }
        out_->layers.push_back(std::move(layer));
    }

  private:
    void keep(const nlohmann::json& layer, std::size_t page, Picture picture) {
        out_->pictures[fmt::format("{} {}", layer["name"].get<std::string>(), page)] = std::move(picture);
    }
    const BakeReport* bake_;
    StopFlag stop_;
    BakeLayers* out_;
};

/// The least power of two by which pages are reduced so that `bytes_per_texel` keep to `most_bytes`.
std::size_t factor_for(std::span<const LightmapPage> pages, std::size_t bytes_per_texel, std::size_t most_bytes) {
    for (std::size_t factor = 1;; factor *= 2) {
        std::size_t texels = 0;
        bool least = true;
        for (const LightmapPage& page : pages) {
            texels += Extent(page, factor).size();
            least &= page.width <= factor && page.height <= factor;
        }
        if (least || texels <= most_bytes / bytes_per_texel) return factor;
    }
}

/// Base64 of half floats, three channels or one.
constexpr std::size_t k_colour_bytes = 8, k_number_bytes = 3;

void add_irradiance(LayerWriter& writer, const BakeReport& bake, std::size_t factor) {
    const auto& pages = bake.light.pages;
    const auto& channels = bake.light.channels;
    const char* const group = "Irradiance";
    writer.add<Rgb>({{"name", "E"},
                     {"title", "Irradiance"},
                     {"symbol", "E"},
                     {"note", "at the shading normal, from the path tracer"},
                     {"unit", "W/m²"},
                     {"group", group},
                     {"kind", "light"},
                     {"factor", 1 / k_pi}},
                    factor,
                    [&](std::size_t p, std::size_t i) { return colour_of(pages[p], channels.irradiance(0), i); });
    if (bake.codec_irradiance.empty()) return;
    writer.add<Rgb>({{"name", "E codec"},
                     {"title", "Irradiance by the codec"},
                     {"symbol", "E codec"},
                     {"note", "at the shading normal, from the coefficients"},
                     {"unit", "W/m²"},
                     {"group", group},
                     {"kind", "light"},
                     {"factor", 1 / k_pi}},
                    factor, [&](std::size_t p, std::size_t i) { return bake.codec_irradiance[p][i]; });
}

void add_quality(LayerWriter& writer, const BakeReport& bake, std::size_t factor, std::vector<nlohmann::json>& layers) {
    const auto& pages = bake.light.pages;
    const auto& channels = bake.light.channels;
    const char* const group = "Quality";
    if (!bake.codec_irradiance.empty())
        layers.push_back({{"name", "difference"},
                          {"title", "Codec against paths"},
                          {"symbol", "E error"},
                          {"note", "signed difference of E"},
                          {"group", group},
                          {"kind", "signed_error"},
                          {"scale", 0.2},
                          {"difference", {"E codec", "E"}}});
    writer.add<float>({{"name", "error"},
                       {"title", "Standard error of E"},
                       {"symbol", "Std. error"},
                       {"note", "over E, as the lightmap holds it"},
                       {"group", group},
                       {"kind", "error"},
                       {"scale", 0.2}},
                      factor, [&](std::size_t p, std::size_t i) {
                          const float e = luminance(colour_of(pages[p], channels.irradiance(0), i));
                          const float error = pages[p].planes[channels.error()][i];
                          return e > 0 ? error / e : 0.0f;
                      });
    writer.add<float>({{"name", "validity"},
                       {"title", "Validity"},
                       {"note", "share of paths that do not hit a back face first"},
                       {"group", group},
                       {"kind", "share"}},
                      factor, [&](std::size_t p, std::size_t i) { return pages[p].validity[i]; });
    writer.add_charts({{"name", "charts"}, {"title", "Charts"}, {"group", group}, {"kind", "charts"}}, factor);
}

void add_coefficients(LayerWriter& writer, const BakeReport& bake, std::size_t factor) {
    const auto& pages = bake.light.pages;
    const auto& channels = bake.light.channels;
    for (std::size_t c = 0; c < channels.coefficients; ++c) {
        const std::string name = fmt::format("c{}", c);
        writer.add<Rgb>(
            {{"name", name},
             {"title", fmt::format("Coefficient {}", c)},
             {"symbol", name},
             {"group", "Coefficients"},
             {"kind", "coefficient"}},
            factor, [&](std::size_t p, std::size_t i) { return colour_of(pages[p], channels.coefficient(c, 0), i); });
    }
}

}  // namespace

BakeLayers bake_layers(const BakeReport& bake, const BakeReportOptions& options) {
    BakeLayers out;
    if (bake.light.pages.empty()) return out;
    // Half of the room for what every bake has, half for the coefficients, of which there may be many.
    const std::size_t base_bytes = 2 * k_colour_bytes + 3 * k_number_bytes;
    const std::size_t factor = factor_for(bake.light.pages, base_bytes, options.most_layer_bytes / 2);
    const std::size_t coefficient_bytes = k_colour_bytes * std::max<std::size_t>(1, bake.light.channels.coefficients);
    const std::size_t coefficient_factor =
        std::max(factor, factor_for(bake.light.pages, coefficient_bytes, options.most_layer_bytes / 2));
    LayerWriter writer(bake, options.stop, out);
    add_irradiance(writer, bake, factor);
    add_quality(writer, bake, factor, out.layers);
    add_coefficients(writer, bake, coefficient_factor);
    return out;
}

}  // namespace lobelia
