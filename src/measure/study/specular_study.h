// The study of specular reflection from spherical Gaussians and spherical harmonics.
#pragma once

#include "lobelia/specular.h"
#include "measure/study/study.h"

namespace lobelia {

/// Points over the sphere, each seen at one angle to its normal from one side or another, all of one alpha.
struct PointsAtAngle {
    Directions normals, views;
    std::vector<float> alphas;
    PointsAtAngle(std::size_t count, float cosine, float alpha);
    [[nodiscard]] SpecularPoints view() const { return {normals, views, alphas}; }
};

/// RMS difference between two evaluators on the same coefficients, over the RMS of `reference`; of
/// green.
[[nodiscard]] double relative_specular_error(const SpecularEvaluator& evaluator, const SpecularEvaluator& reference,
                                             std::span<const Rgb> c, const PointsAtAngle& points);

/// Error tables of every evaluator over roughness, view angle and sharpness, curves, and lit spheres.
[[nodiscard]] Study study_specular();

}  // namespace lobelia
