// Light sources as the sampling of lights sees them, and their grouping by position.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lobelia/math.h"
#include "lobelia/sampling.h"

namespace lobelia {

struct LightSource {
    enum class Kind : std::uint8_t { environment, sun, triangle, punctual };
    Kind kind = Kind::environment;
    std::uint32_t index = 0;  ///< index of the sun, the emissive triangle or the punctual light
    float strength = 0;       ///< luminance of irradiance (far) or of intensity (near)
    Vec3 centre;              ///< near: centre of its bounding sphere; far: direction towards it, or 0: all around
    float radius = 0;         ///< near: radius of the sphere; far: sine of the angular radius
    Vec3 front;               ///< normal of a one-sided triangle; 0: visible from all sides
    float least = 0;          ///< the triangle is visible from offsets along `front` above this
    float area = 0;           ///< triangles only [m^2]
    std::uint32_t group = 0;
    float share = 1;  ///< probability within its group
};

/// Sources that share one sampling weight, which is evaluated for each shading point.
struct LightGroup {
    std::uint32_t first = 0;  ///< index of the first source; the others follow it
    bool far = false;
    float strength = 0;  ///< sum over its sources
    Vec3 centre;
    float radius = 0;
    Vec3 front;                       ///< common normal of one-sided triangles; 0: visible from all sides
    float least = 0;                  ///< least offset along `front` from which any of its sources is visible
    std::optional<AliasTable> table;  ///< for choosing among several sources
};

/// Makes a group of sources whose indices start at `first`, and sets their probabilities within it.
[[nodiscard]] LightGroup make_group(std::span<LightSource> sources, std::uint32_t first);

/// Splits near sources into groups, each small or weak enough that the distance to its centre represents all its
/// sources.
[[nodiscard]] std::vector<std::vector<LightSource>> grouped_by_place(std::vector<LightSource> sources);

}  // namespace lobelia
