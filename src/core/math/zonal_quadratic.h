// Functions of degree 2 that are zonal beyond degree 1: what ZH3 and its relatives come to, radiance and irradiance.
#pragma once

#include <array>

#include "lobelia/planes.h"

namespace lobelia {

/// f(w) = constant + linear . w + quadratic P_2(axis . w), P_2(t) = (3 t^2 - 1) / 2.
struct ZonalQuadratic {
    float constant = 0;
    Vec3 linear;
    float quadratic = 0;
    Vec3 axis{0, 0, 1};
};

/// One function for each channel.
void evaluate(const std::array<ZonalQuadratic, 3>& functions, DirectionView directions, MutableColourView out);

}  // namespace lobelia
