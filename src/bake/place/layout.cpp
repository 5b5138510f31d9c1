// Sizes of objects and their placement on pages.
#include "bake/place/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bake/place/pack_rectangles.h"

namespace lobelia {
namespace {

/// The part of the UV square that an object uses, and its size in the world.
struct Extent {
    std::uint32_t object = 0;
    double x0 = 1, y0 = 1, x1 = 0, y1 = 0;  ///< clipped to [0, 1]
    double metres_per_uv = 0;               ///< root of world area over UV area; 0 if either is 0
};

Extent extent_of(const World& world, std::uint32_t object) {
    Extent result{.object = object};
    double world_area = 0, uv_area = 0;
    for (std::size_t t = world.first_triangle[object]; t < world.first_triangle[object + 1]; ++t) {
        const auto [a, b, c] = world.triangles[t];
        for (const std::uint32_t v : {a, b, c}) {
            const double x = std::clamp(world.lightmap_uv[v].x, 0.0f, 1.0f);
            const double y = std::clamp(world.lightmap_uv[v].y, 0.0f, 1.0f);
            result.x0 = std::min(result.x0, x);
            result.y0 = std::min(result.y0, y);
            result.x1 = std::max(result.x1, x);
            result.y1 = std::max(result.y1, y);
        }
        const Vec3 p = world.positions[a];
        world_area += length(cross(world.positions[b] - p, world.positions[c] - p)) / 2.0;
        const double ax = world.lightmap_uv[a].x, ay = world.lightmap_uv[a].y;
        uv_area += std::abs((world.lightmap_uv[b].x - ax) * (world.lightmap_uv[c].y - ay) -
                            (world.lightmap_uv[b].y - ay) * (world.lightmap_uv[c].x - ax)) /
                   2;
    }
    result.x1 = std::max(result.x0, result.x1);
    result.y1 = std::max(result.y0, result.y1);
    if (world_area > 0 && uv_area > 0 && std::isfinite(world_area) && std::isfinite(uv_area))
        result.metres_per_uv = std::sqrt(world_area / uv_area);
    return result;
}

/// Returns the texels that the object needs along an axis of `extent` UV units; at least one. The slack absorbs
/// rounding.
double texels_for(double extent, double scale) { return std::max(1.0, std::ceil(extent * scale - 1e-3)); }

double scale_at(const Extent& e, double texels_per_metre) {
    return e.metres_per_uv > 0 ? e.metres_per_uv * texels_per_metre : 1;
}

bool fits(const Extent& e, double scale, const AtlasOptions& options) {
    return texels_for(e.x1 - e.x0, scale) <= static_cast<double>(options.width) &&
           texels_for(e.y1 - e.y0, scale) <= static_cast<double>(options.height);
}

/// The objects' rectangles at a density.
std::vector<PackedRectangle> rectangles_at(std::span<const Extent> extents, double texels_per_metre) {
    std::vector<PackedRectangle> rectangles;
    for (const Extent& e : extents) {
        const double scale = scale_at(e, texels_per_metre);
        rectangles.push_back({.width = static_cast<int>(texels_for(e.x1 - e.x0, scale)),
                              .height = static_cast<int>(texels_for(e.y1 - e.y0, scale))});
    }
    return rectangles;
}

PackOptions pack_options(const AtlasOptions& options, StopFlag stop) {
    return {static_cast<int>(options.width), static_cast<int>(options.height), static_cast<int>(options.padding), stop};
}

ObjectPlacements packed_at(const World& world, std::span<const Extent> extents, double texels_per_metre,
                           const PackOptions& options) {
    std::vector<PackedRectangle> rectangles = rectangles_at(extents, texels_per_metre);
    ObjectPlacements result;
    result.pages = pack_rectangles(rectangles, options);
    result.placements.resize(world.has_lightmap_uv.size());
    for (std::size_t i = 0; i < extents.size(); ++i) {
        const Extent& e = extents[i];
        const PackedRectangle& r = rectangles[i];
        const double scale = scale_at(e, texels_per_metre);
        const auto s = static_cast<float>(scale);
        result.placements[e.object] = {r.page,
                                       {s, s},
                                       {static_cast<float>(r.x - e.x0 * scale), static_cast<float>(r.y - e.y0 * scale)},
                                       {r.x, r.y, r.x + r.width, r.y + r.height},
                                       true};
    }
    return result;
}

/// Returns the maximum density, to about one in a thousand, at which all objects fit one page.
double density_for_one_page(std::span<const Extent> extents, const AtlasOptions& options, StopFlag stop) {
    // Start at the density whose rectangles fill a page completely.
    double area = 0;
    for (const Extent& e : extents) area += e.metres_per_uv * e.metres_per_uv * (e.x1 - e.x0) * (e.y1 - e.y0);
    double high = area > 0 ? std::sqrt(static_cast<double>(options.width * options.height) / area) : 1, low = 0;
    for (int step = 0; step < 10; ++step) {
        // Halve until the objects fit, then bisect.
        const double middle = low > 0 ? (low + high) / 2 : high / 2;
        const bool one_page = std::all_of(extents.begin(), extents.end(),
                                          [&](const Extent& e) { return fits(e, scale_at(e, middle), options); }) &&
                              fits_one_page(rectangles_at(extents, middle), pack_options(options, stop));
        (one_page ? low : high) = middle;
    }
    return low > 0 ? low : high;
}

}  // namespace

ObjectPlacements shared_layout(const World& world, const AtlasOptions& options) {
    ObjectPlacements result{std::vector<AtlasPlacement>(world.has_lightmap_uv.size()), 1};
    for (std::size_t i = 0; i < result.placements.size(); ++i)
        if (world.has_lightmap_uv[i] != 0)
            result.placements[i] = {0,
                                    {static_cast<float>(options.width), static_cast<float>(options.height)},
                                    {0, 0},
                                    {0, 0, static_cast<int>(options.width), static_cast<int>(options.height)},
                                    true};
    return result;
}

Result<ObjectPlacements> packed_layout(const World& world, const AtlasOptions& options, StopFlag stop) {
    std::vector<Extent> extents;
    for (std::uint32_t i = 0; i < world.has_lightmap_uv.size(); ++i) {
        stop.check();
        if (world.has_lightmap_uv[i] != 0) extents.push_back(extent_of(world, i));
    }
    const double density =
        options.texels_per_metre ? *options.texels_per_metre : density_for_one_page(extents, options, stop);
    for (const Extent& e : extents)
        if (const double scale = scale_at(e, density); !fits(e, scale, options))
            return Error{
                fmt::format("{} needs {:.0f} x {:.0f} texels at {:.4g} texels per metre, but pages have {} x {}: "
                            "choose larger pages or fewer texels per metre",
                            world.name_of(e.object), texels_for(e.x1 - e.x0, scale), texels_for(e.y1 - e.y0, scale),
                            density, options.width, options.height)};
    return packed_at(world, extents, density, pack_options(options, stop));
}

}  // namespace lobelia
