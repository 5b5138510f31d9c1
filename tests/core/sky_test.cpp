// Tests the default sky: its sun keeps its energy at any resolution, and the sky is plausible, smooth and lit.
#include "lobelia/sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/math/colour.h"
#include "lobelia/environment.h"

namespace lobelia {
namespace {

constexpr double radians(double degrees) { return degrees * k_pi / 180; }

Vec3 at_elevation(double degrees, double azimuth = 0) {
    const double e = radians(degrees), a = radians(azimuth);
    return {static_cast<float>(std::cos(e) * std::sin(a)), static_cast<float>(std::sin(e)),
            static_cast<float>(-std::cos(e) * std::cos(a))};
}

std::vector<SkyOptions> many_options() {
    std::vector<SkyOptions> options;
    for (const double turbidity : {2.0, 3.0, 5.0, 10.0})
        for (const double elevation : {0.1, 1.0, 5.0, 20.0, 40.0, 70.0, 90.0})
            options.push_back({turbidity, elevation, 30, 0.3});
    return options;
}

TEST(Sky, SunEnergyIsKeptAtEveryResolution) {
    for (const double elevation : {1.0, 40.0, 89.9}) {
        const SkyOptions options{3, elevation, 130, 0.2};
        const Sky background(options);
        const SunDisc disc = sun_disc(options);
        for (const LatLong grid :
             {LatLong{1, 1}, LatLong{8, 4}, LatLong{64, 32}, LatLong{257, 129}, LatLong{1024, 512}}) {
            const Image image = sky(grid, options);
            double energy = 0;
            for (std::size_t i = 0; i < grid.size(); ++i)
                energy += grid.solid_angle(i / grid.width) *
                          (static_cast<double>(image.pixels[i].g) - background(grid.direction(i)).g);
            const double expected = disc.radiance.g * disc.solid_angle;
            EXPECT_NEAR(energy, expected, 1e-4 * expected) << grid.width << " at " << elevation;
        }
    }
}

TEST(Sky, SunIsWhereItsAnglesSay) {
    const LatLong grid{512, 256};
    for (const double azimuth : {-90.0, 0.0, 45.0, 170.0}) {
        const Image image = sky(grid, {3, 30, azimuth, 0.2});
        const auto brightest = std::max_element(image.pixels.begin(), image.pixels.end(),
                                                [](Rgb a, Rgb b) { return luminance(a) < luminance(b); });
        const Vec3 found = grid.direction(static_cast<std::size_t>(brightest - image.pixels.begin()));
        EXPECT_GT(dot(found, at_elevation(30, azimuth)), std::cos(radians(0.8))) << azimuth;
    }
}

TEST(Sky, DiscAtHighResolutionIsEven) {
    // Texels well inside the disc all hold its radiance.
    const SkyOptions options{3, 30, 0, 0.2};
    const LatLong grid{4096, 2048};
    const SunDisc disc = sun_disc(options);
    const Image image = sky(grid, options);
    for (const double dx : {-0.1, 0.0, 0.1}) {
        for (const double dy : {-0.1, 0.0, 0.1}) {
            const float value = image.pixels[grid.index(at_elevation(30 + dy, dx))].g;
            EXPECT_NEAR(value, disc.radiance.g, 0.1 * disc.radiance.g) << dx << " " << dy;
        }
    }
}

TEST(Sky, FiniteAndNotNegativeEverywhere) {
    const LatLong grid{64, 33};
    for (const SkyOptions& options : many_options()) {
        for (const Rgb& pixel : sky(grid, options).pixels) {
            ASSERT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
            ASSERT_TRUE(pixel.r >= 0 && pixel.g >= 0 && pixel.b >= 0);
            ASSERT_GT(luminance(pixel), 0);
        }
    }
}

TEST(Sky, ContinuousAcrossTheHorizon) {
    // The steepest change is from sky to ground within one degree: smoothstep's slope is 1.5 / degree.
    constexpr double k_step = 0.01;
    for (const SkyOptions& options : many_options()) {
        const Sky radiance(options);
        const float largest = std::max(luminance(radiance(at_elevation(0))), luminance(radiance.ground()));
        for (double elevation = -2; elevation < 2; elevation += k_step) {
            const float low = luminance(radiance(at_elevation(elevation))),
                        high = luminance(radiance(at_elevation(elevation + k_step)));
            EXPECT_LE(std::abs(high - low), 0.02 * largest)
                << elevation << " at turbidity " << options.turbidity << ", sun " << options.sun_elevation;
        }
    }
}

TEST(Sky, GroundReflectsWhatItReceives) {
    const LatLong grid{1024, 512};
    for (const double elevation : {5.0, 40.0, 80.0}) {
        const SkyOptions options{4, elevation, 20, 0.35};
        const Image image = sky(grid, options);
        double irradiance = 0;
        for (std::size_t i = 0; i < grid.size() / 2; ++i)
            irradiance += image.pixels[i].r * grid.solid_angle(i / grid.width) * grid.direction(i).y;
        EXPECT_NEAR(image.pixels.back().r, 0.35 / k_pi * irradiance, 1e-3 * image.pixels.back().r);
    }
}

TEST(Sky, ZenithLuminanceIsThePublishedOne) {
    // Turbidity 3 and a sun at 40 degrees: chi = (4/9 - 3/120) (pi - 2 * 50 degrees) = 0.585657, tan chi = 0.663320, so
    // (4.0453 * 3 - 4.9710) * 0.663320 - 0.2155 * 3 + 2.4192 = 6.5253 kcd/m^2.
    const Sky radiance(SkyOptions{3, 40, 0, 0.2});
    EXPECT_NEAR(luminance(radiance({0, 1, 0})) * k_white_efficacy, 6525.3, 0.001 * 6525.3);
}

TEST(Sky, SunIsPlausible) {
    const auto illuminance = [](double turbidity, double elevation) {
        const SunDisc disc = sun_disc({turbidity, elevation, 0, 0.2});
        return luminance(disc.radiance) * disc.solid_angle * k_white_efficacy;
    };
    // A high sun in clear air gives about 100 klx; thick haze and long paths through air give much less.
    EXPECT_NEAR(illuminance(2, 90), 100e3, 8e3);
    for (double elevation = 5; elevation < 90; elevation += 5) {
        EXPECT_LT(illuminance(3, elevation), illuminance(3, elevation + 5));
        EXPECT_LT(illuminance(6, elevation), illuminance(3, elevation));
        const Rgb low = sun_disc({3, elevation, 0, 0.2}).radiance, high = sun_disc({3, elevation + 5, 0, 0.2}).radiance;
        EXPECT_LT(low.b / low.r, high.b / high.r);
    }
}

TEST(Sky, AzimuthShiftsTheImage) {
    // Rounding may move one of the disc's 4096 points from one texel to the next.
    const LatLong grid{36, 18};
    const Image from = sky(grid, {3, 50, 5, 0.2}), to = sky(grid, {3, 50, 45, 0.2});
    for (std::size_t y = 0; y < grid.height; ++y)
        for (std::size_t x = 0; x < grid.width; ++x)
            EXPECT_NEAR(to.at((x + 4) % grid.width, y).g, from.at(x, y).g, 1e-3 * from.at(x, y).g);
}

TEST(Sky, OptionsOutsideTheModelAreRefused) {
    EXPECT_TRUE(check(SkyOptions{}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const SkyOptions& options :
         {SkyOptions{1.9}, SkyOptions{10.1}, SkyOptions{nan}, SkyOptions{3, 0}, SkyOptions{3, 91},
          SkyOptions{3, 40, nan}, SkyOptions{3, 40, 0, -0.1}, SkyOptions{3, 40, 0, 1.1}}) {
        EXPECT_FALSE(check(options));
    }
}

}  // namespace
}  // namespace lobelia
