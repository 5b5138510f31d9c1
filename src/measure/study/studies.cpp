// The list of studies of formulae.
#include "measure/study/studies.h"

#include <array>

#include "measure/study/sg_study.h"
#include "measure/study/specular_study.h"

namespace lobelia {
namespace {

constexpr std::array k_studies = {
    StudyEntry{"irradiance", "Irradiance formulae of spherical Gaussians against the exact integral",
               study_sg_irradiance},
    StudyEntry{"specular", "Specular reflection of lobes and harmonics against ray tracing", study_specular},
};

}  // namespace

std::span<const StudyEntry> studies() { return k_studies; }

}  // namespace lobelia
