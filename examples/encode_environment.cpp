// Encodes an environment into twelve coefficients, evaluates irradiance, and measures its error.
#include <cstdio>

#include "lobelia/lobelia.h"

int main() {
    using namespace lobelia;

    // Samples: every texel of an environment once.
    const Image environment = sky({256, 128});
    const Samples samples = shuffled_texel_samples(environment, Domain::sphere, 1);

    // Encode: twelve spherical Gaussians, by least squares.
    const Codec codec = make_codec("sg12/least-squares/hill").value();
    const std::vector<Rgb> coefficients = codec.encode(samples);

    // Evaluate: irradiance at normals all around.
    const LatLong grid{32, 16};
    const Directions normals = grid.directions();
    Colours irradiance(normals.size());
    codec.irradiance(coefficients, normals, irradiance);

    // Measure: against the exact irradiance of the same samples.
    Colours exact(normals.size());
    irradiance_sum(samples, normals, exact);
    const Errors wrong = errors(irradiance, exact, grid.solid_angles());
    const Rgb up = colour_at(irradiance, grid.index({0, 1, 0}));
    std::printf("%zu samples in %zu coefficients: irradiance upwards %.3g %.3g %.3g W/m^2, sMAPE %.2g\n",  //
                samples.size(), coefficients.size(), up.r, up.g, up.b, wrong.smape);
    return wrong.smape < 0.2 ? 0 : 1;
}
