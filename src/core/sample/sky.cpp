// A clear sky with its sun, after Preetham, Shirley & Smits, "A Practical Analytic Model for Daylight" (1999), with the
// distribution of Perez, Seals & Michalsky (1993) and the colour matching functions of Wyman, Sloan & Shirley (2013).
#include "lobelia/sky.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "core/math/colour.h"
#include "core/math/quadrature.h"

namespace lobelia {

namespace {

constexpr double radians(double degrees) { return degrees * k_pi / 180; }

Vec3 sun_direction(const SkyOptions& options) {
    const double e = radians(options.sun_elevation), a = radians(options.sun_azimuth);
    return {static_cast<float>(std::cos(e) * std::sin(a)), static_cast<float>(std::sin(e)),
            static_cast<float>(-std::cos(e) * std::cos(a))};
}

Rgb without_negatives(Rgb c) { return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)}; }

/// A photometric colour [cd/m^2] as radiance; what lies outside the gamut is cut.
Rgb radiance_from(Xyz c) {
    return without_negatives(rgb_from({c.x / k_white_efficacy, c.y / k_white_efficacy, c.z / k_white_efficacy}));
}

/// sum_i sum_j t^(2 - i) m_ij theta^(3 - j): the chromaticity of the zenith (appendix A.2).
double zenith_chromaticity(const std::array<std::array<double, 4>, 3>& m, double turbidity, double theta) {
    double sum = 0;
    for (const auto& row : m) sum = sum * turbidity + ((row[0] * theta + row[1]) * theta + row[2]) * theta + row[3];
    return sum;
}

constexpr std::array<std::array<double, 4>, 3> k_zenith_x{
    {{0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr std::array<std::array<double, 4>, 3> k_zenith_y{
    {{0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}}};

/// Luminance of the zenith [cd/m^2] (appendix A.2).
double zenith_luminance(double t, double theta) {
    const double chi = (4.0 / 9 - t / 120) * (k_pi - 2 * theta);
    return 1000 * ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192);
}

/// Radiance of a black body per wavelength [W/(m^2 sr m)] (Planck 1900).
double black_body(double wavelength, double temperature) {
    constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
    return 2 * h * c * c / std::pow(wavelength, 5) / std::expm1(h * c / (wavelength * k * temperature));
}

/// Ozone's absorption [1/cm] from 450 to 770 nm in steps of 10 (table 2); 0 elsewhere in the visible.
constexpr std::array<double, 33> k_ozone{0.003, 0.006, 0.009, 0.014, 0.021, 0.030, 0.040, 0.048, 0.063, 0.075, 0.085,
                                         0.103, 0.120, 0.120, 0.115, 0.125, 0.120, 0.105, 0.090, 0.079, 0.067, 0.057,
                                         0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009, 0.007, 0.004};

/// Returns the transmittance of sunlight of `nanometres` through relative air mass `m` (appendix A.1). Water vapour and
/// mixed gases are ignored: they absorb beyond 690 nm, where 0.2 % of the sun's luminance lies.
double transmittance(int nanometres, double turbidity, double m) {
    const double um = nanometres * 1e-3;
    const double rayleigh = 0.008735 * std::pow(um, -4.08);
    const double aerosol = (0.04608 * turbidity - 0.04586) * std::pow(um, -1.3);
    const int row = (nanometres - 450) / 10;
    const bool absorbed = nanometres >= 450 && row < static_cast<int>(k_ozone.size());
    const double ozone = absorbed ? 0.35 * k_ozone[static_cast<std::size_t>(row)] : 0;
    return std::exp(-m * (rayleigh + aerosol + ozone));
}

/// The CIE 1931 colour matching functions, within 1 % of their maxima.
Xyz colour_matching(double nm) {
    const auto lobe = [nm](double peak, double left, double right) {
        const double t = (nm - peak) / (nm < peak ? left : right);
        return std::exp(-0.5 * t * t);
    };
    return {1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
            0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
            1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)};
}

std::string out_of_range(const char* option, double value, const char* range) {
    return std::string("sky: ") + option + " is " + std::to_string(value) + "; the model holds " + range;
}

}  // namespace

Status check(const SkyOptions& o) {
    if (!(o.turbidity >= 2 && o.turbidity <= 10)) return Error{out_of_range("turbidity", o.turbidity, "from 2 to 10")};
    if (!(o.sun_elevation > 0 && o.sun_elevation <= 90))
        return Error{out_of_range("sun elevation", o.sun_elevation, "above 0 and up to 90 degrees")};
    if (!std::isfinite(o.sun_azimuth)) return Error{out_of_range("sun azimuth", o.sun_azimuth, "for finite angles")};
    if (!(o.ground_albedo >= 0 && o.ground_albedo <= 1))
        return Error{out_of_range("ground albedo", o.ground_albedo, "from 0 to 1")};
    return Done{};
}

SunDisc sun_disc(const SkyOptions& options) {
    if (const Status valid = check(options); !valid) contract_violated(valid.error().message);
    // Find the relative air mass between the sun and the ground (Kasten 1966).
    const double theta = 90 - options.sun_elevation;
    const double m = 1 / (std::cos(radians(theta)) + 0.15 * std::pow(93.885 - theta, -1.253));

    // Integrate what remains of the sun's light, a black body of 5772 K, against the colour matching functions.
    constexpr double k_sun_temperature = 5772, k_lumen_per_watt = 683, k_step = 10e-9;
    Xyz sum;
    for (int nm = 380; nm <= 780; nm += 10) {
        const double L = black_body(nm * 1e-9, k_sun_temperature) * transmittance(nm, options.turbidity, m);
        const Xyz weight = colour_matching(nm);
        const double scale = k_lumen_per_watt * k_step * L;
        sum = {sum.x + scale * weight.x, sum.y + scale * weight.y, sum.z + scale * weight.z};
    }
    return {radiance_from(sum), 2 * k_pi * (1 - std::cos(radians(k_sun_radius))), sun_direction(options)};
}

double Sky::Perez::operator()(double cos_theta, double gamma) const {
    // b is negative, so the first factor tends to 1 at the horizon.
    const double gradient = cos_theta > 0 ? 1 + a * std::exp(b / cos_theta) : 1;
    const double cos_gamma = std::cos(gamma);
    return scale * gradient * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
}

Sky::Perez Sky::perez(std::array<double, 5> k, double zenith, double sun_theta) {
    Perez result{k[0], k[1], k[2], k[3], k[4], 1};
    result.scale = zenith / result(1, sun_theta);
    return result;
}

Sky::Sky(const SkyOptions& options) : sun_(sun_direction(options)) {
    if (const Status valid = check(options); !valid) contract_violated(valid.error().message);
    // Set up the three distributions (appendix A.2).
    const double t = options.turbidity, theta = radians(90 - options.sun_elevation);
    luminance_ = perez(
        {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
        zenith_luminance(t, theta), theta);
    x_ = perez(
        {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
        zenith_chromaticity(k_zenith_x, t, theta), theta);
    y_ = perez(
        {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529},
        zenith_chromaticity(k_zenith_y, t, theta), theta);

    // Light the ground: its radiance is albedo E / pi, with E from all of the sky and the sun.
    const SphereRule rule = product_rule(Domain::hemisphere, 32);
    const SunDisc sun = sun_disc(options);
    Rgb irradiance = sun.radiance * static_cast<float>(sun.solid_angle * sun.direction.y);
    for (std::size_t i = 0; i < rule.weights.size(); ++i) {
        // The rule's axis is z.
        const Vec3 d = direction_at(rule.directions.view(), i);
        irradiance = irradiance + above_horizon({d.y, d.z, d.x}) * static_cast<float>(rule.weights[i] * d.z);
    }
    ground_ = irradiance * static_cast<float>(options.ground_albedo / k_pi);
}

Rgb Sky::above_horizon(Vec3 direction) const {
    const double gamma = std::acos(std::clamp(static_cast<double>(dot(direction, sun_)), -1.0, 1.0));
    const Chromaticity c{x_(direction.y, gamma), y_(direction.y, gamma)};
    return radiance_from(xyz_from(c, luminance_(direction.y, gamma)));
}

Rgb Sky::operator()(Vec3 direction) const {
    if (direction.y >= 0) return above_horizon(direction);
    const double depth = std::min(-direction.y / std::sin(radians(1)), 1.0);
    const float share = static_cast<float>(depth * depth * (3 - 2 * depth));
    return share < 1 ? above_horizon(direction) * (1 - share) + ground_ * share : ground_;
}

namespace {

/// Adds the sun's disc to the texels under it: many points of equal solid angle on the disc, on a spiral of golden
/// angles, each give their share of the energy to the texel that holds them.
void add_sun(Image& image, const SunDisc& sun) {
    // Choose the number of points by the number of texels that the disc may cover.
    const LatLong grid = lat_long(image);
    constexpr double k_points_per_texel = 64, k_least = 4096, k_most = 1 << 22;
    const double texel = 2 * k_pi * k_pi / static_cast<double>(grid.size());
    const int count = static_cast<int>(std::clamp(k_points_per_texel * sun.solid_angle / texel, k_least, k_most));

    // Count the points in each texel.
    const Vec3 side = normalize(std::abs(sun.direction.y) < 0.9f ? Vec3{-sun.direction.z, 0, sun.direction.x}
                                                                 : cross(sun.direction, {1, 0, 0}));
    const Vec3 up = cross(sun.direction, side);
    const double golden_angle = k_pi * (3 - std::sqrt(5.0)), height = 1 - std::cos(radians(k_sun_radius));
    std::map<std::size_t, int> points;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - height * (i + 0.5) / count, radius = std::sqrt(1 - z * z), phi = golden_angle * i;
        const Vec3 d = side * static_cast<float>(radius * std::cos(phi)) +
                       up * static_cast<float>(radius * std::sin(phi)) + sun.direction * static_cast<float>(z);
        ++points[grid.index(normalize(d))];
    }

    // Turn shares of energy into mean radiance.
    for (const auto& [index, n] : points) {
        const double scale = sun.solid_angle * n / count / grid.solid_angle(index / grid.width);
        image.pixels[index] = image.pixels[index] + sun.radiance * static_cast<float>(scale);
    }
}

}  // namespace

Image sky(LatLong grid, const SkyOptions& options) {
    check_grid(grid);
    const Sky radiance(options);
    Image image(grid.width, grid.height);
    for (std::size_t i = 0; i < grid.size(); ++i) image.pixels[i] = radiance(grid.direction(i));
    add_sun(image, sun_disc(options));
    return image;
}

}  // namespace lobelia
