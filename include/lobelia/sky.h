// The default environment: a clear sky with its sun above a plain ground, after Preetham, Shirley & Smits 1999.
#pragma once

#include "lobelia/environment.h"
#include "lobelia/result.h"

namespace lobelia {

/// Position of the sun, and haziness of the air. The model was fitted for the ranges given here.
struct SkyOptions {
    /// Haziness: 2 very clear, 3 clear, 6 hazy, 10 thick haze.
    double turbidity = 3;
    /// Height of the sun's centre above the horizon [degrees], in (0, 90].
    double sun_elevation = 40;
    /// Azimuth of the sun from -z, the image's centre, towards +x [degrees].
    double sun_azimuth = 45;
    /// Reflectance of the ground, in [0, 1], grey and Lambertian.
    double ground_albedo = 0.2;
};

/// Angular radius of the sun's disc [degrees].
inline constexpr double k_sun_radius = 0.2665;

/// Checks the options. Errors name the first one outside its range.
[[nodiscard]] Status check(const SkyOptions& options);

/// Returns the mean radiance of the sun's disc as seen from the ground [W/(m^2 sr)] and the solid angle of the disc
/// [sr].
struct SunDisc {
    Rgb radiance;
    double solid_angle = 0;
    Vec3 direction;
};
[[nodiscard]] SunDisc sun_disc(const SkyOptions& options);

/// Returns the radiance of the sky without its sun, or of the ground [W/(m^2 sr)], for unit directions; y is up.
/// Finite, non-negative and continuous: over the first degree below the horizon sky blends smoothly into ground.
class Sky {
  public:
    /// Precondition: check(options).
    explicit Sky(const SkyOptions& options);
    [[nodiscard]] Rgb operator()(Vec3 direction) const;
    [[nodiscard]] Rgb ground() const { return ground_; }

  private:
    /// Perez's five coefficients, and the value at the zenith divided by the formula's value there.
    struct Perez {
        double a, b, c, d, e, scale;
        [[nodiscard]] double operator()(double cos_theta, double gamma) const;
    };
    static Perez perez(std::array<double, 5> coefficients, double zenith, double sun_theta);
    [[nodiscard]] Rgb above_horizon(Vec3 direction) const;

    Vec3 sun_;
    Perez x_, y_, luminance_;
    Rgb ground_;
};

/// Makes the environment: sky and ground at each texel's centre, and the sun's disc distributed over the texels that it
/// covers, so that its integral over the image is radiance times solid angle at every resolution. Luminance is
/// converted to W/(m^2 sr) by k_white_efficacy, 179 lm/W. Preconditions: the grid is at least 1 x 1, check(options).
[[nodiscard]] Image sky(LatLong grid, const SkyOptions& options = {});

}  // namespace lobelia
