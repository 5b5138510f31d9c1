// Plane geometry of triangles and texels, in double precision: containment, weights, clipping.
// Clipping follows Sutherland and Hodgman 1974.
#pragma once

#include <array>
#include <cstddef>

#include "lobelia/lightmap.h"

namespace lobelia {

/// A point on a page [texels].
struct PagePoint {
    double x = 0, y = 0;
};

[[nodiscard]] TexelBox intersection(const TexelBox& a, const TexelBox& b);

/// A convex polygon; a triangle clipped to a box has at most 7 corners.
struct Polygon {
    std::array<PagePoint, 8> corners;
    std::size_t size = 0;

    /// Returns the unsigned area.
    [[nodiscard]] double area() const;
    /// Returns the mean of its area; the mean of its corners if the area is 0. Precondition: at least one corner.
    [[nodiscard]] PagePoint centroid() const;
    /// Returns its point nearest to `p`. Precondition: at least one corner.
    [[nodiscard]] PagePoint nearest(PagePoint p) const;
};

/// A triangle on a page, of either winding. All results for float inputs are exact but for one rounding, so that
/// triangles that share an edge leave no gap between them.
class PageTriangle {
  public:
    explicit PageTriangle(const std::array<Vec2, 3>& corners);

    /// Returns whether it is too thin to own texels. Precondition of all functions below except box(): it is not.
    [[nodiscard]] bool degenerate() const { return degenerate_; }
    /// Returns the texels that its bounding box touches, clipped to `limits`.
    [[nodiscard]] TexelBox box(const TexelBox& limits) const;
    /// Returns whether `p` lies in it or on its border.
    [[nodiscard]] bool contains(PagePoint p) const;
    /// Returns whether `p` lies in it, farther than `margin` from its border.
    [[nodiscard]] bool contains(PagePoint p, double margin) const;
    /// Returns whether it may touch the inside of a box: false only if an edge separates them.
    [[nodiscard]] bool may_touch(const TexelBox& box) const;
    /// Returns the barycentric weights at `p`; they sum to 1.
    [[nodiscard]] std::array<float, 3> weights(PagePoint p) const;
    /// Returns its part within texel (x, y).
    [[nodiscard]] Polygon part_in(int x, int y) const;

  private:
    /// Returns twice the signed area of edge i and `p`: positive inside.
    [[nodiscard]] double beyond(std::size_t i, PagePoint p) const {
        return direction_[i].x * (p.y - corners_[i].y) - direction_[i].y * (p.x - corners_[i].x);
    }

    std::array<PagePoint, 3> corners_;    ///< as given
    std::array<PagePoint, 3> direction_;  ///< direction from corner i to the next, oriented so that inside is positive
    double twice_area_ = 0;
    bool degenerate_ = false;
};

}  // namespace lobelia
