// The tangent frame of a normal: Duff et al. 2017.
#include <cmath>

#include "baker/texels.h"

namespace lobelia {

Rotation tangent_from_world(Vec3 normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    return {Vec3{1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
            Vec3{b, sign + normal.y * normal.y * a, -normal.y}, normal};
}

}  // namespace lobelia
