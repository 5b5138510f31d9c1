// Plane geometry of triangles and texels, in double precision: containment, weights, clipping.
// Clipping follows Sutherland and Hodgman 1974.
#pragma once

#include <array>
#include <cstddef>

#include "lobelia/lightmap.h"

namespace lobelia {

/// A point of a page [texels].
struct PagePoint {
    double x = 0, y = 0;
};

[[nodiscard]] TexelBox intersection(const TexelBox& a, const TexelBox& b);

/// A convex polygon: what is left of a triangle within a box has at most 7 corners.
struct Polygon {
    std::array<PagePoint, 8> corners;
    std::size_t size = 0;

    /// Without sign.
    [[nodiscard]] double area() const;
    /// Mean of its area, or of its corners where it has none. It has at least one corner.
    [[nodiscard]] PagePoint centroid() const;
    /// Its point nearest to `p`. It has at least one corner.
    [[nodiscard]] PagePoint nearest(PagePoint p) const;
};

/// A triangle on a page, of either winding. Between floats all of these are exact but for one rounding, so that
/// triangles that share an edge leave no gap between them.
class PageTriangle {
  public:
    explicit PageTriangle(const std::array<Vec2, 3>& corners);

    /// Too thin to own anything: the functions below, other than box(), are not for such a triangle.
    [[nodiscard]] bool degenerate() const { return degenerate_; }
    /// The texels that its bounding box touches, cut to `limits`.
    [[nodiscard]] TexelBox box(const TexelBox& limits) const;
    /// Whether `p` lies in it or on its border.
    [[nodiscard]] bool contains(PagePoint p) const;
    /// Whether `p` lies in it, farther than `margin` from its border.
    [[nodiscard]] bool contains(PagePoint p, double margin) const;
    /// Whether it may touch the inside of a box: false only if an edge separates them.
    [[nodiscard]] bool may_touch(const TexelBox& box) const;
    /// Weights of its corners at `p`; they sum to 1.
    [[nodiscard]] std::array<float, 3> weights(PagePoint p) const;
    /// Its part within texel (x, y).
    [[nodiscard]] Polygon part_in(int x, int y) const;

  private:
    /// Twice the signed area of edge i and `p`: positive inside.
    [[nodiscard]] double beyond(std::size_t i, PagePoint p) const {
        return direction_[i].x * (p.y - corners_[i].y) - direction_[i].y * (p.x - corners_[i].x);
    }

    std::array<PagePoint, 3> corners_;    ///< as given
    std::array<PagePoint, 3> direction_;  ///< of the edge from corner i to the next, turned so that inside is positive
    double twice_area_ = 0;
    bool degenerate_ = false;
};

}  // namespace lobelia
