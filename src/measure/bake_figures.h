// Measures a bake object by object.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/render/render.h"
#include "lobelia/scene.h"

namespace lobelia {

/// The texels of one object. Invalid ones are counted and left out of the means.
struct ObjectFigures {
    std::string name;
    std::size_t texels = 0, invalid = 0;
    Rgb irradiance;             ///< mean E [W/m^2]
    double standard_error = 0;  ///< RMS of the standard error of E's luminance, over the mean
    double codec_error = 0;     ///< RMS of E by the codec minus E by the paths (luminance), over the mean
    std::uint32_t page = 0;     ///< the lightmap page that holds its texels
    TexelBox box;               ///< the smallest box around them
};

/// One entry for each object of the scene; names are those of `scene`. `codec_irradiance` may be empty.
[[nodiscard]] std::vector<ObjectFigures> object_figures(const Scene& scene, const BakedLight& light,
                                                        std::span<const std::uint32_t> object_of_chart,
                                                        std::span<const std::vector<Rgb>> codec_irradiance);

}  // namespace lobelia
