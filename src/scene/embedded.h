// Scenes made by code, complete with lightmap UVs: for trying the baker, for tests, and as examples to write out.
#pragma once

#include <span>
#include <string_view>

#include "lobelia/result.h"
#include "lobelia/scene.h"

namespace lobelia {

/// The Cornell box (Goral et al. 1984) at the size of a room, 5.5 m wide and high and 5.6 m deep, its walls made
/// rectangular: it is watertight except for its open front, and symmetric about x = 0 and z = 0, with its floor at y =
/// 0. Red is on the left, green on the right.
struct CornellOptions {
    bool closed = false;           ///< a sixth, white wall in front, and the camera inside
    bool blocks = true;            ///< the short and the tall block
    Rgb lamp_radiance{17, 12, 4};  ///< radiance of the lamp, 1.30 x 1.05 m, 1 cm below the ceiling [W/(m^2 sr)]
};
[[nodiscard]] Scene cornell_scene(const CornellOptions& options = {});

/// A gallery open to the south through four arches on columns, with steps in front of it and curtains in three of the
/// arches, under the clear sky of sky.h. The sun is a directional light with the angular radius of its disc; the
/// environment holds sky and ground without it.
struct ColonnadeOptions {
    double sun_elevation = 31;     ///< [degrees]
    double sun_azimuth = 140;      ///< from -z towards +x [degrees]; 180 shines straight in
    std::size_t sky_height = 256;  ///< rows of the environment; it has twice as many columns
};
[[nodiscard]] Scene colonnade_scene(const ColonnadeOptions& options = {});

/// A square landscape of 2 quads^2 triangles in one chart, a million by default: for measuring the cost of large
/// scenes.
struct TerrainOptions {
    float side = 100;         ///< side length [m]
    std::size_t quads = 708;  ///< along each side
};
[[nodiscard]] Scene terrain_scene(const TerrainOptions& options = {});

/// Returns the names that embedded_scene accepts, except "terrain", in order.
[[nodiscard]] std::span<const std::string_view> embedded_scene_names();

/// Returns the scene of this name with its default options, or the "terrain". Errors: an unknown name (lists the
/// names).
[[nodiscard]] Result<Scene> embedded_scene(std::string_view name);

}  // namespace lobelia
