// Containment, barycentric weights and clipping of triangles on pages.
#include "bake/place/plane.h"

#include <algorithm>
#include <cmath>

namespace lobelia {
namespace {

/// Minimum area [texels^2] of a triangle that can own texels, times two: a millionth of a texel.
constexpr double k_least_twice_area = 2e-6;

double cross_product(PagePoint a, PagePoint b) { return a.x * b.y - a.y * b.x; }
PagePoint difference(PagePoint a, PagePoint b) { return {a.x - b.x, a.y - b.y}; }

/// Clips `polygon` to the part where `height` >= 0; height is linear.
template <class Height>
Polygon cut(const Polygon& polygon, const Height& height) {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size; ++i) {
        const PagePoint a = polygon.corners[i], b = polygon.corners[(i + 1) % polygon.size];
        const double ha = height(a), hb = height(b);
        if (ha >= 0 && result.size < result.corners.size()) result.corners[result.size++] = a;
        if ((ha >= 0) != (hb >= 0) && result.size < result.corners.size()) {
            const double s = ha / (ha - hb);
            result.corners[result.size++] = {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
        }
    }
    return result;
}

/// Rounds by floor or ceil, clamping to [low, high] before the conversion to int.
int cut_to(double value, int low, int high) {
    return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
}

}  // namespace

TexelBox intersection(const TexelBox& a, const TexelBox& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

double Polygon::area() const {
    double twice = 0;
    for (std::size_t i = 2; i < size; ++i)
        twice += cross_product(difference(corners[i - 1], corners[0]), difference(corners[i], corners[0]));
    return std::abs(twice) / 2;
}

PagePoint Polygon::centroid() const {
    // Weight the centroids of a fan of triangles by their areas.
    double twice = 0;
    PagePoint sum, mean;
    for (std::size_t i = 0; i < size; ++i) {
        mean.x += corners[i].x / static_cast<double>(size);
        mean.y += corners[i].y / static_cast<double>(size);
    }
    for (std::size_t i = 2; i < size; ++i) {
        const PagePoint a = difference(corners[i - 1], corners[0]), b = difference(corners[i], corners[0]);
        const double w = cross_product(a, b);
        twice += w;
        sum.x += w * (a.x + b.x) / 3;
        sum.y += w * (a.y + b.y) / 3;
    }
    if (std::abs(twice) < 1e-12) return mean;
    return {corners[0].x + sum.x / twice, corners[0].y + sum.y / twice};
}

PagePoint Polygon::nearest(PagePoint p) const {
    PagePoint best = corners[0];
    double best_squared = HUGE_VAL;
    for (std::size_t i = 0; i < size; ++i) {
        const PagePoint a = corners[i], d = difference(corners[(i + 1) % size], a), ap = difference(p, a);
        const double squared = d.x * d.x + d.y * d.y;
        const double s = squared > 0 ? std::clamp((d.x * ap.x + d.y * ap.y) / squared, 0.0, 1.0) : 0.0;
        const PagePoint q{a.x + s * d.x, a.y + s * d.y}, pq = difference(p, q);
        if (const double distance = pq.x * pq.x + pq.y * pq.y; distance < best_squared) {
            best_squared = distance;
            best = q;
        }
    }
    return best;
}

PageTriangle::PageTriangle(const std::array<Vec2, 3>& corners) {
    for (std::size_t i = 0; i < 3; ++i) corners_[i] = {corners[i].x, corners[i].y};
    twice_area_ = cross_product(difference(corners_[1], corners_[0]), difference(corners_[2], corners_[0]));
    degenerate_ = !(std::abs(twice_area_) > k_least_twice_area);
    const double sign = twice_area_ < 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const PagePoint d = difference(corners_[(i + 1) % 3], corners_[i]);
        direction_[i] = {sign * d.x, sign * d.y};
    }
}

TexelBox PageTriangle::box(const TexelBox& limits) const {
    const auto [x0, x1] = std::minmax({corners_[0].x, corners_[1].x, corners_[2].x});
    const auto [y0, y1] = std::minmax({corners_[0].y, corners_[1].y, corners_[2].y});
    return {cut_to(std::floor(x0), limits.x0, limits.x1), cut_to(std::floor(y0), limits.y0, limits.y1),
            cut_to(std::ceil(x1), limits.x0, limits.x1), cut_to(std::ceil(y1), limits.y0, limits.y1)};
}

bool PageTriangle::contains(PagePoint p) const { return beyond(0, p) >= 0 && beyond(1, p) >= 0 && beyond(2, p) >= 0; }

bool PageTriangle::contains(PagePoint p, double margin) const {
    for (std::size_t i = 0; i < 3; ++i)
        if (beyond(i, p) <= margin * std::hypot(direction_[i].x, direction_[i].y)) return false;
    return true;
}

bool PageTriangle::may_touch(const TexelBox& box) const {
    for (std::size_t i = 0; i < 3; ++i) {
        // Test the corner of the box that lies farthest inside the edge.
        const PagePoint p{static_cast<double>(direction_[i].y < 0 ? box.x1 : box.x0),
                          static_cast<double>(direction_[i].x < 0 ? box.y0 : box.y1)};
        if (beyond(i, p) <= 0) return false;
    }
    return true;
}

std::array<float, 3> PageTriangle::weights(PagePoint p) const {
    const double area = std::abs(twice_area_);
    const double w0 = beyond(1, p) / area, w1 = beyond(2, p) / area;
    return {static_cast<float>(w0), static_cast<float>(w1), static_cast<float>(1 - w0 - w1)};
}

Polygon PageTriangle::part_in(int x, int y) const {
    Polygon polygon;
    std::copy(corners_.begin(), corners_.end(), polygon.corners.begin());
    polygon.size = 3;
    polygon = cut(polygon, [&](PagePoint p) { return p.x - x; });
    polygon = cut(polygon, [&](PagePoint p) { return x + 1 - p.x; });
    polygon = cut(polygon, [&](PagePoint p) { return p.y - y; });
    return cut(polygon, [&](PagePoint p) { return y + 1 - p.y; });
}

}  // namespace lobelia
