// Checks that lightmap UVs can be baked.
#include "scene/lightmap_check.h"

#include <algorithm>

namespace lobelia {
namespace {

/// A range of grid indices, clipped to the square to limit the cost of triangles beyond it.
struct UvBox {
    std::size_t begin, end;
};
UvBox clipped(float low, float high, std::size_t grid) {
    const auto cut = [&](float x) { return std::clamp(static_cast<double>(x), 0.0, static_cast<double>(grid)); };
    return {static_cast<std::size_t>(cut(low)), static_cast<std::size_t>(std::ceil(cut(high)))};
}

/// Returns twice the signed area of a triangle, positive if it turns from x to y.
double turn(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

/// Calls `visit` with each grid point inside a triangle, without its edges.
template <class Visit>
void for_each_point(const std::array<Vec2, 3>& t, std::size_t grid, Visit visit) {
    std::array<std::array<double, 2>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = {static_cast<double>(t[k].x), static_cast<double>(t[k].y)};
    if (turn(p[0], p[1], p[2]) < 0) std::swap(p[1], p[2]);
    const UvBox columns = clipped(std::min({t[0].x, t[1].x, t[2].x}), std::max({t[0].x, t[1].x, t[2].x}), grid);
    const UvBox rows = clipped(std::min({t[0].y, t[1].y, t[2].y}), std::max({t[0].y, t[1].y, t[2].y}), grid);
    constexpr double k_edge = 1e-9;
    for (std::size_t y = rows.begin; y < rows.end; ++y)
        for (std::size_t x = columns.begin; x < columns.end; ++x) {
            // Sample a little off the texels' centres, because charts may have edges there.
            const std::array<double, 2> c{static_cast<double>(x) + 0.4863, static_cast<double>(y) + 0.4929};
            if (turn(p[0], p[1], c) > k_edge && turn(p[1], p[2], c) > k_edge && turn(p[2], p[0], c) > k_edge)
                visit(y * grid + x);
        }
}

}  // namespace

LightmapCheck check_lightmap(const World& world, std::size_t first, std::size_t last, std::size_t grid) {
    LightmapCheck result;
    std::vector<std::uint8_t> count(grid * grid);
    for (std::size_t object = first; object < last; ++object) {
        if (world.has_lightmap_uv[object] == 0) continue;
        for (std::uint32_t t = world.first_triangle[object]; t < world.first_triangle[object + 1]; ++t) {
            std::array<Vec2, 3> uv;
            for (std::size_t k = 0; k < 3; ++k) {
                uv[k] = world.lightmap_uv[world.triangles[t][k]];
                result.outside += !(uv[k].x >= 0 && uv[k].x <= 1 && uv[k].y >= 0 && uv[k].y <= 1);
                uv[k] = uv[k] * static_cast<float>(grid);
            }
            for_each_point(uv, grid, [&](std::size_t i) {
                if (count[i] == 0) ++result.covered;
                if (count[i] == 1 && result.overlapping++ == 0) result.first_overlapping = t;
                if (count[i] < 2) ++count[i];
            });
        }
    }
    return result;
}

}  // namespace lobelia
