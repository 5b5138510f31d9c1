// The tangent frame of a normal: Frisvad 2012, with its pole in a direction that surfaces seldom face.
#include "bake/place/texels.h"

namespace lobelia {
namespace {

/// An orthonormal frame of nonzero rational numbers. No axis, and no diagonal between axes, lies within 24 degrees of
/// -k_z.
constexpr Vec3 k_x{3.0f / 7, -6.0f / 7, 2.0f / 7}, k_y{6.0f / 7, 2.0f / 7, -3.0f / 7},
    k_z{2.0f / 7, 3.0f / 7, 6.0f / 7};

}  // namespace

Rotation tangent_from_world(Vec3 normal) {
    // Rotate the frame from k_z to the normal by the shortest arc.
    const float a = dot(k_x, normal), b = dot(k_y, normal), along = dot(k_z, normal);
    // 1 + along, without cancellation where the normal is nearly -k_z. From k_z to -k_z any rotation will do.
    const float c = along > 0 ? 1 + along : (a * a + b * b) / (1 - along);
    if (c < 1e-12f) return {k_x, k_y * -1.0f, normal};
    const Vec3 h = (k_x * a + k_y * b) * (1 / c) + k_z;
    return {k_x - h * a, k_y - h * b, normal};
}

}  // namespace lobelia
