// Tests for occluders by rays across seams.
#include "bake/finish/seam_walls.h"

#include <cmath>

#include "bake/place/texel_points.h"

namespace lobelia {
namespace {

/// Height of the rays above the surface, and their reach beyond the edge, over the length within the triangle. Equal,
/// the rays clear the surface at edges that bend by less than 45 degrees.
constexpr float k_height = 0.02f;

/// One side of a seam at one point: directions are unit.
struct SideAt {
    Vec3 edge;
    Vec3 normal;  ///< normal of the triangle
    Vec3 inward;  ///< perpendicular to the edge, into the triangle
    float reach;  ///< a texel's width, limited by the triangle's extent [m]
};

SideAt side_at(const Atlas& atlas, const SeamSide& side, float s) {
    const World& world = atlas.world();
    const auto& [a, b, c] = world.triangles[side.triangle];
    const Vec3 centre = (world.positions[a] + world.positions[b] + world.positions[c]) * (1.0f / 3);
    SideAt at{side.positions[0] * (1 - s) + side.positions[1] * s, world.face_normal(side.triangle), {}, 0};
    const Vec3 along = side.positions[1] - side.positions[0], across = cross(at.normal, along);
    const float size = length(across);
    if (!(size > 0)) return at;
    at.inward = across * (1 / size);
    // The centre of a triangle lies at a third of its height above each edge.
    float height = 3 * dot(centre - at.edge, at.inward);
    if (height < 0) {
        at.inward = at.inward * -1.0f;
        height = -height;
    }
    at.reach = std::min(texel_width(atlas, side.triangle), 0.9f * height);
    return at;
}

/// Returns whether a surface lies between a point inside `from` and a point just beyond the edge, on `to`.
bool is_hit(const PathTracer& tracer, const SideAt& from, const SideAt& to) {
    const float height = std::max(k_height * from.reach, 4 * tracer.lift(from.edge));
    const Vec3 start = from.edge + from.inward * from.reach + from.normal * height;
    const Vec3 end = to.edge + to.inward * height + to.normal * height;
    const float distance = length(end - start);
    if (!(distance > 0) || !(from.reach > height)) return false;
    const PathTracer::Ray ray{start, (end - start) * (1 / distance), distance};
    PathTracer::Hit hit;
    tracer.closest({&ray, 1}, {&hit, 1});
    return std::isfinite(hit.distance) && hit.distance < distance;
}

}  // namespace

bool is_walled(const PathTracer& tracer, const Atlas& atlas, const Seam& seam, float s) {
    const SideAt a = side_at(atlas, seam.a, s), b = side_at(atlas, seam.b, s);
    return is_hit(tracer, a, b) || is_hit(tracer, b, a);
}

}  // namespace lobelia
