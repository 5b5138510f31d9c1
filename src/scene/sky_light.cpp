// The procedural sky as a scene's light.
#include "scene/sky_light.h"

namespace lobelia {

void set_sky(Scene& scene, const SkyOptions& sky_options, std::size_t height) {
    // Add the sun as a directional light with the irradiance of its disc.
    const SunDisc disc = sun_disc(sky_options);
    PunctualLight sun;
    sun.name = "sun";
    sun.kind = PunctualLight::Kind::directional;
    sun.intensity = disc.radiance * static_cast<float>(disc.solid_angle);
    sun.direction = disc.direction * -1;
    sun.angular_radius = static_cast<float>(k_sun_radius * k_pi / 180);
    std::erase_if(scene.lights,
                  [](const PunctualLight& light) { return light.kind == PunctualLight::Kind::directional; });
    scene.lights.push_back(std::move(sun));

    // Render sky and ground without the sun.
    const Sky sky(sky_options);
    const LatLong grid{2 * height, height};
    Image image(grid.width, grid.height);
    for (std::size_t i = 0; i < grid.size(); ++i) image.pixels[i] = sky(grid.direction(i));
    scene.environment = std::move(image);
}

}  // namespace lobelia
