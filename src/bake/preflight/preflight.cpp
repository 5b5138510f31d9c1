// The checks: overlaps and padding on pages, triangles in the world, density, memory and time.
#include "bake/preflight/preflight.h"

#include <oneapi/tbb/combinable.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "bake/place/edges.h"

namespace lobelia {
namespace {

constexpr std::uint32_t k_no_object = 0xffffffff;

using ObjectPair = std::pair<std::uint32_t, std::uint32_t>;
using PairCounts = std::map<ObjectPair, std::size_t>;

/// Marks texels whose centres two triangles cover, and counts them by object; each texel once.
void find_overlaps(const Atlas& atlas, StopFlag stop, Preflight& result) {
    // The margin excludes triangles that share an edge. The points lie a little beside the centres, because edges and
    // diagonals often run through those.
    constexpr double k_margin = 1e-3, k_beside_x = 0.503, k_beside_y = 0.508;
    const World& world = atlas.world();
    tbb::combinable<PairCounts> counts;
    tbb::parallel_for(std::size_t{0}, atlas.tiles(), [&](std::size_t tile) {
        std::vector<TexelMark>& marks = result.pages[atlas.page_of_tile(tile)].mark;
        const TexelBox box = atlas.box_of_tile(tile);
        std::array<std::uint32_t, k_tile * k_tile> first;
        first.fill(k_no_object);
        std::size_t left = static_cast<std::size_t>(box.x1 - box.x0) * static_cast<std::size_t>(box.y1 - box.y0);
        for (const std::uint32_t t : atlas.triangles_of_tile(tile)) {
            // Where all texels are marked, the rest of the triangles change nothing.
            if (left == 0) return;
            stop.check();
            const PageTriangle triangle(atlas.texel_triangle(t));
            const TexelBox part = atlas.box_of(t, triangle, box);
            for (int y = part.y0; y < part.y1; ++y)
                for (int x = part.x0; x < part.x1; ++x) {
                    TexelMark& mark = marks[static_cast<std::size_t>(y) * atlas.width() + static_cast<std::size_t>(x)];
                    if (mark == TexelMark::overlap || !triangle.contains({x + k_beside_x, y + k_beside_y}, k_margin))
                        continue;
                    std::uint32_t& other = first[static_cast<std::size_t>(y - box.y0) * k_tile + (x - box.x0)];
                    if (other != k_no_object) {
                        mark = TexelMark::overlap;
                        --left;
                        ++counts.local()[std::minmax(world.object[other], world.object[t])];
                    } else {
                        other = t;
                    }
                }
        }
    });
    PairCounts all;
    counts.combine_each([&](const PairCounts& part) {
        for (const auto& [pair, count] : part) all[pair] += count;
    });
    for (const auto& [pair, count] : all) {
        result.overlaps.push_back({pair.first, pair.second, count});
        result.objects[pair.first].overlapping_texels += count;
        if (pair.second != pair.first) result.objects[pair.second].overlapping_texels += count;
    }
    std::stable_sort(result.overlaps.begin(), result.overlaps.end(),
                     [](const auto& a, const auto& b) { return a.texels > b.texels; });
}

/// Returns the number of texels between texel i and the nearest of another chart, if fewer than `padding`.
std::optional<std::size_t> free_texels(const std::vector<std::uint32_t>& charts, std::size_t width, std::size_t height,
                                       std::size_t i, std::size_t padding) {
    const std::size_t x = i % width, y = i / width;
    std::optional<std::size_t> least;
    for (std::size_t py = y - std::min(y, padding); py <= std::min(y + padding, height - 1); ++py)
        for (std::size_t px = x - std::min(x, padding); px <= std::min(x + padding, width - 1); ++px) {
            const std::uint32_t chart = charts[py * width + px];
            if (chart == 0 || chart == charts[i]) continue;
            const std::size_t distance = std::max(px > x ? px - x : x - px, py > y ? py - y : y - py);
            if (!least || distance - 1 < *least) least = distance - 1;
        }
    return least;
}

/// Marks covered texels, and those too near to another chart.
void find_tight(const Atlas& atlas, const TexelMap& map, StopFlag stop, Preflight& result) {
    const auto place = [&](std::size_t i) { return map.texels[i].y * atlas.width() + map.texels[i].x; };
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        result.pages[map.texels[i].page].chart[place(i)] = atlas.chart_of_triangle()[map.triangle[i]] + 1;

    tbb::combinable<std::optional<std::size_t>> least;
    tbb::parallel_for(std::size_t{0}, map.texels.size(), [&](std::size_t i) {
        stop.check();
        Preflight::PageMarks& page = result.pages[map.texels[i].page];
        TexelMark& mark = page.mark[place(i)];
        const auto found = free_texels(page.chart, atlas.width(), atlas.height(), place(i), result.padding);
        mark = std::max(mark, found ? TexelMark::tight : TexelMark::covered);
        if (found && (!least.local() || *found < *least.local())) least.local() = found;
    });
    least.combine_each([&](const std::optional<std::size_t>& part) {
        if (part && (!result.least_padding || *part < *result.least_padding)) result.least_padding = part;
    });
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        Preflight::OfObject& object = result.objects[atlas.world().object[map.triangle[i]]];
        ++object.texels;
        object.tight_texels += result.pages[map.texels[i].page].mark[place(i)] == TexelMark::tight;
    }
}

/// Areas of triangle t in the world [m^2] and on its page [texels].
double world_area(const World& world, std::size_t t) {
    const auto& [a, b, c] = world.triangles[t];
    return length(cross(world.positions[b] - world.positions[a], world.positions[c] - world.positions[a])) / 2.0;
}
double texel_area(const Atlas& atlas, std::size_t t) {
    const auto p = atlas.texel_triangle(t);
    const double ax = p[1].x - p[0].x, ay = p[1].y - p[0].y, bx = p[2].x - p[0].x, by = p[2].y - p[0].y;
    return std::abs(ax * by - ay * bx) / 2;
}

bool is_degenerate(const World& world, std::size_t t) {
    // A height below a millionth of the longest side is rounding.
    const auto& [a, b, c] = world.triangles[t];
    const Vec3 sides[] = {world.positions[b] - world.positions[a], world.positions[c] - world.positions[b],
                          world.positions[a] - world.positions[c]};
    double longest = 0;
    for (const Vec3 side : sides) longest = std::max<double>(longest, dot(side, side));
    return 2 * world_area(world, t) <= 1e-6 * longest;
}

bool is_outside(const World& world, std::size_t t) {
    constexpr float k_slack = 1e-4f;
    return std::any_of(world.triangles[t].begin(), world.triangles[t].end(), [&](std::uint32_t v) {
        const Vec2 uv = world.lightmap_uv[v];
        return std::min(uv.x, uv.y) < -k_slack || std::max(uv.x, uv.y) > 1 + k_slack;
    });
}

void check_triangles(const Atlas& atlas, StopFlag stop, Preflight& result) {
    const World& world = atlas.world();
    std::vector<double> mapped(result.objects.size());
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        stop.check();
        Preflight::OfObject& object = result.objects[world.object[t]];
        ++object.triangles;
        const bool degenerate = is_degenerate(world, t);
        object.degenerate_triangles += degenerate;
        if (!object.has_uv) continue;
        object.outside_triangles += is_outside(world, t);
        object.unmapped_triangles += !degenerate && PageTriangle(atlas.texel_triangle(t)).degenerate();
        object.area += world_area(world, t);
        mapped[world.object[t]] += texel_area(atlas, t);
    }
    for (std::size_t i = 0; i < result.objects.size(); ++i)
        if (result.objects[i].area > 0)
            result.objects[i].texels_per_metre = std::sqrt(mapped[i] / result.objects[i].area);

    // Sorting puts edges at one place next to each other, and there those of one object.
    const std::vector<WorldEdge> edges = sorted_edges(world, weld_positions(world, 0, stop));
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
        const std::uint32_t object = world.object[edges[begin].triangle];
        for (end = begin + 1;
             end < edges.size() && edges[end].same_place(edges[begin]) && world.object[edges[end].triangle] == object;)
            ++end;
        result.objects[object].non_manifold_edges += end - begin > 2;
    }
}

Preflight::Density density_of(const Atlas& atlas, StopFlag stop) {
    // Densities of all triangles with the areas that have them.
    const World& world = atlas.world();
    std::vector<std::pair<double, double>> found;
    double area = 0;
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        stop.check();
        if (!atlas.placements()[world.object[t]].baked || is_degenerate(world, t)) continue;
        const double in_world = world_area(world, t), on_page = texel_area(atlas, t);
        if (!(on_page > 0 && in_world > 0) || !std::isfinite(on_page / in_world)) continue;
        found.emplace_back(std::sqrt(on_page / in_world), in_world);
        area += in_world;
    }
    if (found.empty()) return {};
    std::sort(found.begin(), found.end());

    Preflight::Density result{
        .least = found.front().first, .median = 0, .most = found.back().first, .first = 0, .share = {}};
    double below = 0;
    for (const auto& [density, part] : found) {
        below += part;
        if (result.median == 0 && below >= area / 2) result.median = density;
    }
    // Half octaves from the least on, at most as many as a reader would look at.
    constexpr double k_most_bins = 64;
    const double first =
        std::max(std::floor(2 * std::log2(result.least)), std::ceil(2 * std::log2(result.most)) - k_most_bins);
    result.first = std::exp2(first / 2);
    for (const auto& [density, part] : found) {
        const auto bin = static_cast<std::size_t>(std::max(0.0, std::floor(2 * std::log2(density) - first)));
        if (result.share.size() <= bin) result.share.resize(bin + 1);
        result.share[bin] += part / area;
    }
    return result;
}

}  // namespace

BakeMemory bake_memory(const Atlas& atlas, const TexelMap& map, std::size_t state_bytes, std::size_t channels) {
    const std::size_t of_page = atlas.width() * atlas.height();
    BakeMemory result;
    result.scene = atlas.world().triangles.size() * k_bytes_per_triangle;
    result.states = map.texels.size() * state_bytes;
    result.pages = atlas.pages() * of_page * (channels * sizeof(float) + sizeof(std::uint32_t) + sizeof(float));
    result.texels = map.texels.size() * (sizeof(CoveredTexel) + sizeof(std::uint32_t));
    // Position and normal of all pages; for one page at a time brightness, spacing, four weights and one work plane for
    // each of a few threads.
    constexpr std::size_t k_planes_of_work = 3 + 1 + 4 + 4;
    result.finishing = atlas.pages() * of_page * 2 * sizeof(Vec3) + of_page * k_planes_of_work * sizeof(float);
    return result;
}

Preflight preflight(const Atlas& atlas, const TexelMap& map, const PreflightOptions& options) {
    const World& world = atlas.world();
    Preflight result;
    result.width = atlas.width();
    result.height = atlas.height();
    result.texels = map.texels.size();
    result.padding = options.padding;
    result.objects.resize(world.has_lightmap_uv.size());
    for (std::size_t i = 0; i < result.objects.size(); ++i) result.objects[i].has_uv = world.has_lightmap_uv[i] != 0;
    const auto& charts = atlas.chart_of_triangle();
    for (std::size_t t = 0; t < charts.size(); ++t) {
        if (charts[t] == Atlas::k_no_chart) continue;
        result.charts = std::max<std::size_t>(result.charts, charts[t] + 1);
        result.object_of_chart.resize(result.charts);
        result.object_of_chart[charts[t]] = world.object[t];
    }
    const std::size_t texels_of_page = atlas.width() * atlas.height();
    result.pages.assign(atlas.pages(), {std::vector<TexelMark>(texels_of_page, TexelMark::empty),
                                        std::vector<std::uint32_t>(texels_of_page)});
    find_overlaps(atlas, options.stop, result);
    find_tight(atlas, map, options.stop, result);
    check_triangles(atlas, options.stop, result);
    result.density = density_of(atlas, options.stop);
    result.memory = bake_memory(atlas, map, options.state_bytes, options.channels);
    if (options.rate && options.rate->rays_per_second > 0)
        result.seconds = static_cast<double>(result.texels) * options.samples * options.rate->rays_per_sample /
                         options.rate->rays_per_second;
    return result;
}

Preflight preflight(const BakeSetup& setup, std::uint32_t mip_levels, StopFlag stop, std::optional<RayRate> rate) {
    PreflightOptions options;
    options.padding = padding_for_levels(mip_levels);
    options.stop = stop;
    options.state_bytes = setup.layout.bytes();
    options.channels = setup.encoding.page_channels().count();
    options.samples = setup.options.samples;
    options.rate = rate;
    return preflight(setup.atlas, setup.map, options);
}

}  // namespace lobelia
