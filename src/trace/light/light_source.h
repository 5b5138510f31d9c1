// Light sources as the choice between them sees them, and their grouping by place.
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
    std::uint32_t index = 0;  ///< of the sun, the emissive triangle or the punctual light
    float strength = 0;       ///< luminance of irradiance (far) or of intensity (near)
    Vec3 centre;              ///< near: of its bounding sphere; far: direction towards it, or 0: all around
    float radius = 0;         ///< near: of the sphere; far: sine of the angular radius
    Vec3 front;               ///< normal of a one-sided triangle, or 0
    float least = 0;          ///< offset along it from which the triangle is seen
    float area = 0;           ///< of a triangle
    std::uint32_t group = 0;
    float share = 1;  ///< probability within its group
};

/// Sources that are chosen between together; each group is weighed for each point that wants light.
struct LightGroup {
    std::uint32_t first = 0;  ///< its sources lie together
    bool far = false;
    float strength = 0;  ///< as of a source
    Vec3 centre;
    float radius = 0;
    Vec3 front;                       ///< the common normal of one-sided triangles, or 0
    float least = 0;                  ///< the least offset along it from which any of them is seen
    std::optional<AliasTable> table;  ///< over its sources, where there are several
};

/// Makes a group of sources that will lie from `first` on, and sets their shares.
[[nodiscard]] LightGroup make_group(std::span<LightSource> sources, std::uint32_t first);

/// Near sources, parted until each part is small or weak enough for its distance to be judged by its centre.
[[nodiscard]] std::vector<std::vector<LightSource>> grouped_by_place(std::vector<LightSource> sources);

}  // namespace lobelia
