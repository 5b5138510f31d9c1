// Results of a preflight for people: sentences, a histogram of bars, a picture of each page.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "bake/preflight/preflight.h"
#include "core/math/colour.h"
#include "io/counted.h"
#include "io/printable.h"

namespace lobelia {
namespace {

std::string name_of(const Scene& scene, std::size_t object) {
    const bool named = object < scene.objects.size() && !scene.objects[object].name.empty();
    return named ? fmt::format("'{}'", scene.objects[object].name) : fmt::format("object {}", object);
}

/// A count, and its name in two parts: "triangle" and " without area on the page".
struct Subject {
    std::size_t Preflight::OfObject::*count;
    const char* noun;
    const char* rest;
};

/// Lists at most `most` names, then "and 5 more".
std::string some_of(std::span<const std::string> names, std::size_t most = 4) {
    std::string result;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) result += (i > 0 ? ", " : "") + names[i];
    if (names.size() > most) result += fmt::format(" and {} more", names.size() - most);
    return result;
}

/// Returns "3000 triangles without area (2000 of 'wall', 1000 of 'floor')", or nothing if the count is 0.
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

/// Chart colours: hues from green to violet, far apart for consecutive numbers (golden section).
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
            fmt::format("lightmap UVs of {} on {}: their light will be mixed", whose, counted(texels, "texel")));
    }
    if (p.overlaps.size() > k_most_overlaps)
        result.push_back("overlaps between " + counted(p.overlaps.size() - k_most_overlaps, "more pair") +
                         " of objects");
    using Of = Preflight::OfObject;
    warn({&Of::outside_triangles, "triangle", " with lightmap UVs outside [0, 1]"}, "the part outside is not baked");
    if (p.least_padding)
        warn({&Of::tight_texels, "texel", " too close to another chart"},
             fmt::format("{} between charts, {} required; light will bleed", counted(*p.least_padding, "texel"),
                         p.padding));
    warn({&Of::unmapped_triangles, "triangle", " without area on the page"}, "nothing is baked there");
    warn({&Of::degenerate_triangles, "degenerate triangle", ""}, "a triangle without area has no front");
    warn({&Of::non_manifold_edges, "edge", " shared by three or more triangles"}, "their inner side is undefined");

    std::vector<std::string> bare;
    for (std::size_t i = 0; i < p.objects.size(); ++i)
        if (!p.objects[i].has_uv) bare.push_back(name_of(scene, i));
    if (!bare.empty())
        result.push_back(fmt::format("{} without lightmap UVs ({}): lit, but not baked; `lobelia unwrap` makes them",
                                     counted(bare.size(), "object"), some_of(bare)));
    return result;
}

std::string to_text(const Preflight& p, const Scene& scene) {
    const double all =
        static_cast<double>(p.width) * static_cast<double>(p.height) * static_cast<double>(p.pages.size());
    std::string text =
        fmt::format("{} of {} x {} texels, {} covered ({:.1f} %), {}\n", counted(p.pages.size(), "page"), p.width,
                    p.height, p.texels, 100 * static_cast<double>(p.texels) / all, counted(p.charts, "chart"));
    if (!p.density.share.empty())
        text += fmt::format("texels per metre: {:.4g} to {:.4g}, median {:.4g} (share of the area)\n{}",
                            p.density.least, p.density.most, p.density.median, histogram(p.density));
    std::size_t triangles = 0;
    for (const Preflight::OfObject& object : p.objects) triangles += object.triangles;
    text += fmt::format("scene: {}, {}\n", counted(p.objects.size(), "object"), counted(triangles, "triangle"));
    const BakeMemory& memory = p.memory;
    text += fmt::format("memory: {} (scene {}, states {}, pages {}, texels {}, finishing {})\n", bytes(memory.total()),
                        bytes(memory.scene), bytes(memory.states), bytes(memory.pages), bytes(memory.texels),
                        bytes(memory.finishing));
    if (p.seconds) text += fmt::format("time: about {}\n", duration(*p.seconds));
    for (const std::string& warning : warnings(p, scene)) text += "warning: " + printable(warning) + '\n';
    return text;
}

Image8 preflight_picture(const Preflight& p, std::size_t page, std::size_t most_side) {
    assert(page < p.pages.size() && most_side > 0);
    const std::size_t shrink = (std::max(p.width, p.height) + most_side - 1) / most_side;
    Image8 picture{(p.width + shrink - 1) / shrink, (p.height + shrink - 1) / shrink, {}};
    std::vector<TexelMark> worst(picture.width * picture.height, TexelMark::empty);
    std::vector<Pixel> pixels(worst.size(), k_free);
    const auto& [marks, charts] = p.pages[page];
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const std::size_t at = i / p.width / shrink * picture.width + i % p.width / shrink;
        if (charts[i] == 0 || marks[i] <= worst[at]) continue;
        worst[at] = marks[i];
        pixels[at] = marks[i] == TexelMark::overlap ? k_overlap
                     : marks[i] == TexelMark::tight ? k_tight
                                                    : chart_colour(charts[i] - 1);
    }
    picture.rgb.reserve(3 * pixels.size());
    for (const Pixel& pixel : pixels) picture.rgb.insert(picture.rgb.end(), pixel.begin(), pixel.end());
    return picture;
}

}  // namespace lobelia
