// Glossy reflection of spherical harmonics: convolution with the reflection's zonal part, pre-filtered, or degree 1 as
// a lamp. Ramamoorthi and Hanrahan 2002; Kautz et al. 2002; Karis 2013; Sloan 2008; O'Donnell 2018.
#pragma once

#include <string_view>

#include "lobelia/specular.h"

namespace lobelia {

/// Names for a degree, the most accurate last. sh-dominant: degree 1 as ambient light and a lamp in its direction, the
/// surface rougher the less it points. sh-prefiltered: bands damped as for a view along the normal, read in the mirror
/// direction, times the albedo. sh-convolution: bands damped by the reflection's own zonal part, read in its mean
/// direction: exact to degree 1.
[[nodiscard]] std::vector<std::string> sh_specular_names();
[[nodiscard]] std::shared_ptr<const SpecularEvaluator> sh_specular(std::string_view name, std::size_t degree);

}  // namespace lobelia
