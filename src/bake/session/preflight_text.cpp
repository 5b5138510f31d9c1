// What preflight found, for people: sentences, a histogram of bars, a picture of each page.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "bake/session/preflight.h"
#include "core/math/colour.h"
#include "io/counted.h"

namespace lobelia {
namespace {

std::string name_of(const Scene& scene, std::size_t object) {
    const bool named = object < scene.objects.size() && !scene.objects[object].name.empty();
    return named ? fmt::format("'{}'", scene.objects[object].name) : fmt::format("object {}", object);
}

/// What is counted, as "triangle" and " without area on the page".
struct Subject {
    std::size_t Preflight::OfObject::*count;
    const char* noun;
    const char* rest;
};

/// At most `most` of the names, "and 5 more".
std::string some_of(std::span<const std::string> names, std::size_t most = 4) {
    std::string result;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) result += (i > 0 ? ", " : "") + names[i];
    if (names.size() > most) result += fmt::format(" and {} more", names.size() - most);
    return result;
}

/// "3000 triangles without area (2000 of 'wall', 1000 of 'floor')", or nothing where there are none.
std::string listed(const Preflight& preflight, const Scene& scene, const Subject& subject) {
    std::vector<std::pair<std::size_t, std::size_t>> objects;
    std::size_t all = 0;
    for (std::size_t i = 0; i < preflight.objects.size(); ++i)
        if (const std::size_t count = preflight.objects[i].*subject.count; count > 0) {
            objects.emplace_back(count, i);
            all += count;
        }
    if (all == 0) return {};
    std::stable_sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::string> names;
    for (const auto& [count, object] : objects) names.push_back(fmt::format("{} of {}", count, name_of(scene, object)));
    return fmt::format("{}{} ({})", counted(all, subject.noun), subject.rest, some_of(names));
}

std::string bytes(std::size_t count) {
    const double mebibytes = static_cast<double>(count) / (1 << 20);
    return mebibytes < 1024 ? fmt::format("{:.1f} MiB", mebibytes) : fmt::format("{:.2f} GiB", mebibytes / 1024);
}

std::string duration(double seconds) {
    if (seconds < 100) return fmt::format("{:.0f} s", std::max(1.0, seconds));
    if (seconds < 100 * 60) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

std::string histogram(const Preflight::Density& density) {
    std::string result;
    const double most = *std::max_element(density.share.begin(), density.share.end());
    for (std::size_t i = 0; i < density.share.size(); ++i) {
        const double from = density.first * std::exp2(static_cast<double>(i) / 2);
        const auto bar = static_cast<std::size_t>(std::lround(40 * density.share[i] / most));
        result += fmt::format("  {:>8.4g} - {:<8.4g} {:5.1f} % {}\n", from, from * std::sqrt(2.0),
                              100 * density.share[i], std::string(bar, '#'));
    }
    return result;
}

using Pixel = std::array<std::uint8_t, 3>;

/// Charts keep to hues between green and violet; hues of neighbours in number lie far apart (golden section).
Pixel chart_colour(std::uint32_t chart) {
    const double turn = std::fmod((chart + 1) * 0.6180339887498949, 1.0);
    const double hue = 6 * (0.25 + 0.55 * turn), value = 0.5 + 0.3 * std::fmod(turn * 7, 1.0);
    const auto channel = [&](double offset) {
        const double distance = std::abs(std::fmod(hue + offset, 6.0) - 3) - 1;
        return static_cast<std::uint8_t>(std::lround(255 * value * (0.35 + 0.65 * std::clamp(distance, 0.0, 1.0))));
    };
    return {channel(0), channel(4), channel(2)};
}

constexpr Pixel k_free{24, 24, 28}, k_tight{255, 150, 0}, k_overlap{230, 20, 20};

}  // namespace

std::vector<std::string> warnings(const Preflight& p, const Scene& scene) {
    std::vector<std::string> result;
    const auto warn = [&](const Subject& subject, std::string_view consequence) {
        if (const std::string list = listed(p, scene, subject); !list.empty())
            result.push_back(fmt::format("{}: {}", list, consequence));
    };
    constexpr std::size_t k_most_overlaps = 8;
    for (std::size_t i = 0; i < std::min(p.overlaps.size(), k_most_overlaps); ++i) {
        const auto& [object, other, texels] = p.overlaps[i];
        const std::string whose = object == other
                                      ? name_of(scene, object) + " overlap each other"
                                      : name_of(scene, object) + " and " + name_of(scene, other) + " overlap";
        result.push_back(
            fmt::format("lightmap UVs of {} on {}: their light will be mixed up", whose, counted(texels, "texel")));
    }
    if (p.overlaps.size() > k_most_overlaps)
        result.push_back("overlaps of " + counted(p.overlaps.size() - k_most_overlaps, "more pair") + " of objects");
    using Of = Preflight::OfObject;
    warn({&Of::outside_triangles, "triangle", " with lightmap UVs out of [0, 1]"}, "what lies outside is not baked");
    if (p.least_padding)
        warn({&Of::tight_texels, "texel", " too near to another chart"},
             fmt::format("{} between charts where {} are needed; light will bleed", counted(*p.least_padding, "texel"),
                         p.padding));
    warn({&Of::unmapped_triangles, "triangle", " without area on the page"}, "nothing is baked there");
    warn({&Of::degenerate_triangles, "degenerate triangle", ""}, "without area there is no front");
    warn({&Of::non_manifold_edges, "edge", " of three triangles and more"},
         "which of their sides is inside cannot be told");

    std::vector<std::string> bare;
    for (std::size_t i = 0; i < p.objects.size(); ++i)
        if (!p.objects[i].has_uv) bare.push_back(name_of(scene, i));
    if (!bare.empty())
        result.push_back(fmt::format("{} without lightmap UVs ({}): lit, but not baked; `lobelia unwrap` makes some",
                                     counted(bare.size(), "object"), some_of(bare)));
    return result;
}

std::string to_text(const Preflight& p, const Scene& scene) {
    const double all = static_cast<double>(p.width) * static_cast<double>(p.height) * static_cast<double>(p.pages);
    std::string text =
        fmt::format("{} of {} x {} texels, {} covered ({:.1f} %), {}\n", counted(p.pages, "page"), p.width, p.height,
                    p.texels, 100 * static_cast<double>(p.texels) / all, counted(p.charts, "chart"));
    if (!p.density.share.empty())
        text += fmt::format("texels per metre: {:.4g} to {:.4g}, median {:.4g} (share of the area)\n{}",
                            p.density.least, p.density.most, p.density.median, histogram(p.density));
    text +=
        fmt::format("memory: {} (states {}, pages {}, texels {}, finishing {})\n", bytes(p.memory.total()),
                    bytes(p.memory.states), bytes(p.memory.pages), bytes(p.memory.texels), bytes(p.memory.finishing));
    if (p.seconds) text += fmt::format("time: about {}\n", duration(*p.seconds));
    for (const std::string& warning : warnings(p, scene)) text += "warning: " + warning + '\n';
    return text;
}

Image8 preflight_picture(const Preflight& p, const Atlas& atlas, const TexelMap& map, std::size_t page,
                         std::size_t most_side) {
    assert(page < p.pages && most_side > 0);
    const std::size_t shrink = (std::max(p.width, p.height) + most_side - 1) / most_side;
    Image8 picture{(p.width + shrink - 1) / shrink, (p.height + shrink - 1) / shrink, {}};
    std::vector<TexelMark> worst(picture.width * picture.height, TexelMark::empty);
    std::vector<Pixel> pixels(worst.size(), k_free);
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        const CoveredTexel& texel = map.texels[i];
        if (texel.page != page) continue;
        const TexelMark mark = p.marks[page][texel.y * p.width + texel.x];
        const std::size_t at = texel.y / shrink * picture.width + texel.x / shrink;
        if (mark <= worst[at]) continue;
        worst[at] = mark;
        pixels[at] = mark == TexelMark::overlap ? k_overlap
                     : mark == TexelMark::tight ? k_tight
                                                : chart_colour(atlas.chart_of_triangle()[map.triangle[i]]);
    }
    picture.rgb.reserve(3 * pixels.size());
    for (const Pixel& pixel : pixels) picture.rgb.insert(picture.rgb.end(), pixel.begin(), pixel.end());
    return picture;
}

}  // namespace lobelia
