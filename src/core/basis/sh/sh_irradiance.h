// Irradiance from spherical harmonics: convolution, windows against ringing, models of what degree 1 leaves out.
// Ramamoorthi and Hanrahan 2001; Sloan 2008 and 2017; Hazel 2017 (Geomerics); Roughton et al. 2024 (ZH3).
#pragma once

#include <string_view>

#include "core/math/harmonics.h"

namespace lobelia {

/// Names for a degree, the most accurate last. convolution: E(n) = sum A_l L_lm Y_lm(n), negative L and E read as 0, as
/// shaders do; convolution-signed: as it is. hann, lanczos, laplacian: the bands damped, by fixed factors. dering:
/// damped just so much that E is nowhere negative. Degree 1 only: geomerics, zh3-hallucinated.
[[nodiscard]] std::vector<std::string> sh_evaluator_names(std::size_t degree);
[[nodiscard]] std::shared_ptr<const Evaluator> sh_evaluator(std::string_view name, std::size_t degree);

/// Factors of the bands 0 .. degree.
/// hann: (1 + cos(pi l / w)) / 2, lanczos: sin(pi l / w) / (pi l / w), both with w = degree + 1.
[[nodiscard]] std::vector<double> hann_window(std::size_t degree);
[[nodiscard]] std::vector<double> lanczos_window(std::size_t degree);
/// 1 / (1 + lambda (l (l + 1))^2), lambda such that the highest band is halved.
[[nodiscard]] std::vector<double> laplacian_window(std::size_t degree);
/// (sin(pi l / w) / (pi l / w))^4; w infinite leaves all as it is.
[[nodiscard]] std::vector<double> dering_window(std::size_t degree, double w);

/// The least of the functions, one a channel, that harmonic coefficients stand for: the lowest of a fixed set of
/// directions, polished by Newton steps on the sphere.
[[nodiscard]] double least_value(std::size_t degree, std::span<const Rgb> c);
/// The largest w (infinity where no damping is needed) at which the irradiance of radiance coefficients `c` is >= 0
/// everywhere, all channels damped alike so that no hue shifts.
[[nodiscard]] double sufficient_window(std::size_t degree, std::span<const Rgb> c);

}  // namespace lobelia
